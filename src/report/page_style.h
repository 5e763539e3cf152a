#pragma once

#include <string_view>

namespace mssim {

/// How a report looks: light and dark, narrow and wide, on paper (A4). Wide tables scroll in boxes of their
/// own on a screen, and are set smaller on paper.
inline constexpr std::string_view page_style = R"(
:root { color-scheme: light dark; --text: #1b1f24; --back: #ffffff; --dim: #57606a; --line: #d0d7de; --fill: #f3f5f7;
  --yes: #116329; --partly: #7d4e00; --no: #a40e26; }
@media (prefers-color-scheme: dark) { :root { --text: #e6edf3; --back: #0d1117; --dim: #9da7b3; --line: #3d444d;
  --fill: #161b22; --yes: #56d364; --partly: #e3b341; --no: #ff8a80; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1rem; max-width: 75rem; color: var(--text); background: var(--back);
  font: 16px/1.5 system-ui, sans-serif; overflow-wrap: break-word; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: .5rem 0; }
h2 { font-size: 1.35rem; margin: 2.2rem 0 .6rem; padding-bottom: .2rem; border-bottom: 1px solid var(--line); }
h3 { font-size: 1.1rem; margin: 1.6rem 0 .5rem; }
h4, h5, h6 { font-size: 1rem; margin: 1.2rem 0 .4rem; }
p, ul { margin: .5rem 0; max-width: 60rem; }
ul { padding-left: 1.2rem; }
code { font: .9em ui-monospace, monospace; }
td code, th code { white-space: nowrap; }
a { color: inherit; }
nav ul { list-style: none; padding: 0; display: flex; flex-wrap: wrap; gap: .2rem 1rem; }
.wide { overflow-x: auto; margin: .6rem 0; max-width: 100%; }
table { border-collapse: collapse; font-size: .875rem; font-variant-numeric: tabular-nums; }
th, td { padding: .25rem .6rem; border-bottom: 1px solid var(--line); text-align: left; vertical-align: top;
  font-weight: normal; max-width: 32rem; }
thead th { font-weight: 600; background: var(--fill); vertical-align: bottom; }
.number { text-align: right; white-space: nowrap; }
thead .number { white-space: normal; }
td.number strong, td strong { font-weight: 600; }
.findings { list-style: none; padding: 0; }
.findings li { padding: .3rem .8rem; margin: .4rem 0; border-left: .3rem solid var(--line); background: var(--fill); }
.findings .yes { border-left-color: var(--yes); }
.findings .partly { border-left-style: double; border-left-color: var(--partly); }
.findings .no { border-left-style: dashed; border-left-color: var(--no); }
.findings .yes > strong:first-child { color: var(--yes); }
.findings .partly > strong:first-child { color: var(--partly); }
.findings .no > strong:first-child { color: var(--no); }
.problems { border-left: .3rem solid var(--no); padding-left: 1.5rem; }
.figures { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 28rem), 1fr)); gap: 1rem; }
figure { margin: .5rem 0; min-width: 0; }
figure svg, figure img { display: block; width: 100%; height: auto; max-width: 38rem; }
figcaption { color: var(--dim); font-size: .875rem; }
summary { cursor: pointer; margin: .5rem 0; }
@media (max-width: 45rem) { table { width: max-content; } th, td { max-width: 15rem; } }
footer { margin-top: 2rem; color: var(--dim); font-size: .875rem; }
@page { size: A4; margin: 14mm 12mm; }
@media print {
  :root { color-scheme: light; --text: #000000; --back: #ffffff; --dim: #444444; --line: #999999; --fill: #f3f3f3;
    --yes: #0b4d20; --partly: #5f3b00; --no: #8a0b1f; }
  body { font-size: 10pt; padding: 0; max-width: none; }
  nav { display: none; }
  details { display: none; }
  .wide { overflow: visible; }
  table { font-size: 7pt; width: 100%; }
  th, td { padding: .1rem .25rem; overflow-wrap: break-word; max-width: none; }
  .number { white-space: normal; }
  h2, h3, h4, h5 { break-after: avoid; }
  figure, tr, .findings li { break-inside: avoid; }
  .figures { grid-template-columns: 1fr 1fr; }
}
)";

}  // namespace mssim
