#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <utility>

#include "output/tables/table.h"
#include "text/text.h"

namespace mssim {
namespace {

struct Replacement {
  std::string_view text, latex;
};

/// What has a meaning in LaTeX, alone or with its neighbour (ligatures; * and [ after a line's end), and the
/// signs of mssim's tables that are not Latin-1. The words beside the last two say the same.
constexpr auto replacements = std::to_array<Replacement>({{"\\", "\\textbackslash{}"},
                                                          {"{", "\\{"},
                                                          {"}", "\\}"},
                                                          {"$", "\\$"},
                                                          {"&", "\\&"},
                                                          {"#", "\\#"},
                                                          {"%", "\\%"},
                                                          {"_", "\\_"},
                                                          {"^", "\\textasciicircum{}"},
                                                          {"~", "\\textasciitilde{}"},
                                                          {"<", "\\textless{}"},
                                                          {">", "\\textgreater{}"},
                                                          {"\"", "\\textquotedbl{}"},
                                                          {"`", "\\textasciigrave{}"},
                                                          {"''", "'{}'{}"},
                                                          {",,", ",{},{}"},
                                                          {"--", "-{}-{}"},
                                                          {"[", "{[}"},
                                                          {"*", "{*}"},
                                                          {"×", "$\\times$"},
                                                          {"–", "--"},
                                                          {"—", "---"},
                                                          {"…", "\\ldots{}"},
                                                          {"†", "\\textdagger{}"},
                                                          {"‡", "\\textdaggerdbl{}"},
                                                          {"≥", "$\\geq$"},
                                                          {"°", "\\textdegree{}"},
                                                          {"√", "$\\surd$"},
                                                          {"µ", "\\textmu{}"},
                                                          {"⁹", "\\textsuperscript{9}"},
                                                          {"✓ ", ""},
                                                          {"✗ ", ""}});

std::string code_text(std::string_view text) {
  std::string result;
  for (std::size_t end = text.find('\''); end != std::string_view::npos; end = text.find('\'')) {
    result += latex_text(text.substr(0, end)) + "\\textquotesingle{}";
    text.remove_prefix(end + 1);
  }
  return result + latex_text(text);
}

std::string marked(TextMark mark, const std::string& content) {
  return (mark == TextMark::code     ? "\\texttt{"
          : mark == TextMark::strong ? "\\textbf{"
                                     : "\\emph{") +
         content + '}';
}

/// Units as tables write them. Those of one letter stand only after a number.
constexpr auto units = std::to_array<Replacement>({{"ms", "\\milli\\second"},
                                                   {"µs", "\\micro\\second"},
                                                   {"ns", "\\nano\\second"},
                                                   {"s", "\\second"},
                                                   {"mm", "\\milli\\metre"},
                                                   {"m", "\\metre"},
                                                   {"GB/s", "\\giga\\byte\\per\\second"},
                                                   {"GiB", "\\gibi\\byte"},
                                                   {"%", "\\percent"}});

/// Whether a number or unit may end before this text.
bool ends_before(std::string_view text) {
  constexpr std::string_view ends = " ),;";
  return text.empty() || ends.find(text.front()) != std::string_view::npos ||
         static_cast<unsigned char>(text.front()) >= 0x80;  // × and marks
}

/// The number that a text begins with, such as "1,054", "0.0898" or "-3.6e-05"; empty for a version, a date
/// or a name. Commas only separate groups of digits.
std::string_view number_at(std::string_view text) {
  const auto is_digit = [&](std::size_t at) {
    return at < text.size() && text[at] >= '0' && text[at] <= '9';
  };
  const auto after_digits = [&](std::size_t at) {
    while (is_digit(at)) ++at;
    return at;
  };
  const std::size_t first = text.starts_with('-') ? 1 : 0;
  if (!is_digit(first)) return {};
  std::size_t end = after_digits(first);
  constexpr std::size_t group = 3;  // digits between commas, as grouped() writes them
  if (end - first <= group)
    while (text.substr(end).starts_with(',') && after_digits(end + 1) == end + 1 + group) end += 1 + group;
  if (text.substr(end).starts_with(',') && is_digit(end + 1)) return {};
  if (text.substr(end).starts_with('.') && is_digit(end + 1)) end = after_digits(end + 1);
  if (const auto rest = text.substr(end); rest.starts_with("e-") || rest.starts_with("e+"))
    end = after_digits(end + 2);
  return ends_before(text.substr(end)) ? text.substr(0, end) : std::string_view();
}

std::string ungrouped(std::string_view number) {
  std::string digits(number);
  std::erase(digits, ',');
  return digits;
}

/// The unit of at least `shortest` bytes that a text begins with; null if there is none.
const Replacement* unit_at(std::string_view text, std::size_t shortest) {
  const auto unit = std::ranges::find_if(units, [&](const Replacement& candidate) {
    return candidate.text.size() >= shortest && text.starts_with(candidate.text) &&
           ends_before(text.substr(candidate.text.size()));
  });
  return unit == units.end() ? nullptr : &*unit;
}

/// The number, range or unit that a text begins with, for siunitx, and its length; nothing if it begins with
/// a word.
std::pair<std::string, std::size_t> quantity_at(std::string_view text) {
  const std::string_view number = number_at(text);
  if (number.empty()) {
    const Replacement* unit = unit_at(text, 2);
    if (!unit) return {};
    return {fmt::format("\\unit{{{}}}", unit->latex), unit->text.size()};
  }
  const std::string_view rest = text.substr(number.size());
  constexpr std::string_view to = " to ";
  if (rest.starts_with(to))
    if (const std::string_view upper = number_at(rest.substr(to.size())); !upper.empty())
      return {fmt::format("\\numrange{{{}}}{{{}}}", ungrouped(number), ungrouped(upper)),
              number.size() + to.size() + upper.size()};
  if (rest.starts_with(' '))
    if (const Replacement* unit = unit_at(rest.substr(1), 1))
      return {fmt::format("\\qty{{{}}}{{{}}}", ungrouped(number), unit->latex),
              number.size() + 1 + unit->text.size()};
  return {fmt::format("\\num{{{}}}", ungrouped(number)), number.size()};
}

std::string cell_words(std::string_view text) {
  std::string result, words;
  bool begins = true;
  while (!text.empty()) {
    const auto [quantity, length] = begins ? quantity_at(text) : std::pair<std::string, std::size_t>();
    if (length > 0) {
      result += latex_text(std::exchange(words, {})) + quantity;
      text.remove_prefix(length);
      begins = false;
    } else {
      begins = text.front() == ' ' || text.front() == '(';
      words += text.front();
      text.remove_prefix(1);
    }
  }
  return result + latex_text(words);
}

/// A cell, or the head of a column (column_of). Of several lines, they are stacked in one that breaks none.
std::string cell_of(std::string_view text, const std::string& column) {
  constexpr TextSpelling stacked{cell_words, code_text, marked, "\\\\"},
      broken{cell_words, code_text, marked, "\\newline "};
  const bool breaks_lines = column.size() > 1;
  const std::string cell = spelled(text, breaks_lines ? broken : stacked);
  return breaks_lines || text.find('\n') == std::string_view::npos
             ? cell
             : fmt::format("\\shortstack[{}]{{{}}}", column, cell);
}

/// A column for tabular: r, l or, of long texts, one that breaks its lines (by the package array, which
/// siunitx loads). That is as wide as its longest word, such as the hash of a commit, in typewriter letters.
std::string column_of(const Table& table, std::size_t column) {
  constexpr std::size_t longest = 40;
  constexpr double usual_mm = 55, letter_mm = 1.7;
  if (is_right_aligned(table, column)) return "r";
  std::size_t widest = 0, widest_word = 0;
  for (const std::vector<Cell>& row : table.rows) {
    const std::string text = cell_text(row[column], table.columns[column]);
    widest = std::max(widest, width_of(text));
    std::istringstream words(text);
    for (std::string word; words >> word;) widest_word = std::max(widest_word, width_of(word));
  }
  if (widest <= longest) return "l";
  return fmt::format(">{{\\raggedright\\arraybackslash}}p{{{:.0f}mm}}",
                     std::max(usual_mm, std::ceil(letter_mm * static_cast<double>(widest_word))));
}

/// Writes the blocks of a page, one after the other.
class LatexPage {
 public:
  LatexPage(const std::string& name, const std::string& remark) : name_(name), remark_(remark) {}

  void operator()(const Heading& heading) {
    if (heading.level == 1) {
      title_ = heading.text;
    } else {
      heading_ = heading.text;
      is_said_ = false;
    }
  }
  void operator()(const Paragraph& paragraph) {
    if (source_.empty() && text_.empty())
      source_ = paragraph.text;
    else
      text_ += said_heading() + latex_prose(paragraph.text) + "\n\n";
  }
  void operator()(const BulletList& list) {
    if (list.items.empty()) return;
    text_ += said_heading() + "\\begin{itemize}\n";
    for (const std::string& item : list.items) text_ += "\\item " + latex_prose(item) + '\n';
    text_ += "\\end{itemize}\n\n";
  }
  void operator()(const Table& table) {
    // Several tables below one heading differ by what stands in their corner.
    const std::string about = !heading_.empty() ? heading_ : tables_ > 0 ? table.columns.front().name : "";
    std::string caption = title_;
    for (const std::string& sentence : {about, source_, remark_})
      if (!sentence.empty()) caption += (caption.ends_with('.') ? " " : ". ") + sentence;
    is_said_ = true;
    text_ +=
        fmt::format("\\begin{{table}}[!htbp]\n\\centering\\small\n\\caption{{{}}}\n\\label{{tab:{}-{}}}\n",
                    latex_prose(caption), name_, ++tables_);
    // A table that is wider than the text is made as wide.
    text_ += "\\resizebox{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}{!}{%\n\\begin{tabular}{";
    std::vector<std::string> columns;
    for (std::size_t i = 0; i < table.columns.size(); ++i) text_ += columns.emplace_back(column_of(table, i));
    text_ += "}\n\\toprule\n";
    line(columns, [&](std::size_t i) { return table.columns[i].name; });
    text_ += "\\midrule\n";
    for (const std::vector<Cell>& row : table.rows)
      line(columns, [&](std::size_t i) { return cell_text(row[i], table.columns[i]); });
    text_ += "\\bottomrule\n\\end{tabular}}\n\\end{table}\n\n";
  }

  std::string text() && { return std::move(text_); }

 private:
  /// The heading, if nothing below it has been written.
  std::string said_heading() {
    return std::exchange(is_said_, true) ? "" : "\\paragraph{" + latex_prose(heading_) + "}\n";
  }

  template <class Text>
  void line(const std::vector<std::string>& columns, Text text) {
    for (std::size_t i = 0; i < columns.size(); ++i)
      text_ += (i == 0 ? "" : " & ") + cell_of(text(i), columns[i]);
    text_ += " \\\\\n";
  }

  const std::string &name_, &remark_;
  std::string title_, heading_, source_, text_;
  bool is_said_ = true;
  int tables_ = 0;
};

}  // namespace

std::string latex_text(std::string_view any_text) {
  const std::string valid = escaped(any_text);
  std::string_view text = valid;
  std::string result;
  while (!text.empty()) {
    const auto found = std::ranges::find_if(
        replacements, [&](const Replacement& candidate) { return text.starts_with(candidate.text); });
    std::size_t length = 1;
    if (found != replacements.end()) {
      result += found->latex;
      length = found->text.size();
    } else {
      const auto [code, bytes] = first_character(text);
      length = bytes;
      const bool is_latin = code < 0x80 || (code >= 0xC0 && code <= 0xFF);
      result +=
          is_latin ? std::string(text.substr(0, length)) : fmt::format("{{[}}U+{:04X}]", std::uint32_t{code});
    }
    text.remove_prefix(length);
  }
  return result;
}

std::string latex_prose(std::string_view text) {
  constexpr TextSpelling spelling{latex_text, code_text, marked, " "};
  return spelled(text, spelling);
}

std::string latex(const Document& document, const std::string& name, const std::string& remark) {
  LatexPage page(name, remark);
  for (const auto& block : document) std::visit(page, block);
  return std::move(page).text();
}

}  // namespace mssim
