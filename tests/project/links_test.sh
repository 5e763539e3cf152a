#!/bin/bash
# Every relative link of every Markdown file, and every picture in its HTML, leads to a file or folder of the repository, and an
# anchor to a heading of its file; README.md stays a page to start from, in short sentences. Arguments: mssim (unused), the source folder.
set -euo pipefail
. "$2/tests/support/command_line.sh"
cd -- "$source"

most_readme_lines=120

# anchors FILE: the anchors of its headings, as GitHub makes them.
anchors() {
  grep -E '^#{1,6} ' -- "$1" | sed -E 's/^#+ //' | tr '[:upper:]' '[:lower:]' | sed -E 's/[^[:alnum:] _-]//g; s/ /-/g'
}

mapfile -t pages < <(find . -path ./build -prune -o -path ./out -prune -o -path ./.git -prune -o -name '*.md' -print | sort)
links=0
for page in "${pages[@]}"; do
  # Indented lines are code; a link's target ends at the first bracket.
  while IFS= read -r target; do
    [[ $target != *://* && $target != mailto:* ]] || continue
    links=$((links + 1))
    file=${target%%#*} anchor=''
    [[ $target != *'#'* ]] || anchor=${target#*#}
    [[ $file ]] && path=${page%/*}/$file || path=$page
    if [[ $file == /* || ! -e $path ]]; then
      fail "$page: there is no $target"
    elif [[ $anchor ]] && ! anchors "$path" | grep -qxF -- "$anchor"; then
      fail "$page: $path has no heading for #$anchor"
    fi
  done < <(grep -vE '^    ' -- "$page" | grep -oP '(\]\(|\b(src|srcset)=")\K[^)" ]+' || true)
done
((${#pages[@]} > 10 && links > 50)) || fail "only $links links in ${#pages[@]} pages were looked at"

lines=$(wc -l <README.md)
((lines <= most_readme_lines)) || fail "README.md has $lines lines; move what is over $most_readme_lines into docs/"
# sentences PAGE: those of its paragraphs and lists, one a line, without code blocks, tables and the targets of links.
sentences() {
  awk '/^(    |[|<#]|$)/ { print ""; next } /^ *- / { print "" } { printf "%s ", $0 }' "$1" |
    sed -E 's/\]\([^)]*\)/]/g; s/[.:;?!]\**\)? +/&\n/g'
}
most_words=30
for page in README.md docs/papers.md; do
  while IFS= read -r sentence; do
    words=$(wc -w <<<"$sentence")
    ((words <= most_words)) || fail "$page: $words words, of at most $most_words: $sentence"
  done < <(sentences "$page")
done
for page in docs/*.md; do
  grep -qF "]($page)" README.md || fail "README.md does not name $page"
done
# From README.md over ARCHITECTURE.md to the force law and the step loop.
grep -qF '](ARCHITECTURE.md' README.md || fail 'README.md does not lead to ARCHITECTURE.md'
for place in kernels/spring_law.h src/backends/spring_list/serial.cpp; do
  grep -qF "]($place)" ARCHITECTURE.md || fail "ARCHITECTURE.md does not lead to $place"
done
