#include "page.hpp"

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>

#include "read_out.hpp"

namespace crankloop::report {
namespace {

constexpr std::size_t kHalfColumns = 5;  // a table with up to this many columns takes half the width of a desktop page
constexpr std::size_t kNarrowColumns = 4;  // a wider table may have to be scrolled on a phone

constexpr const char* kStyle = R"css(
:root { color-scheme: light dark; }
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; text-size-adjust: 100%; }
body {
  margin: 0 auto; padding: 3.5rem clamp(0.9rem, 4vw, 3rem) 4rem; max-width: 76rem;
  background: var(--paper); color: var(--ink);
  font: 1rem/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue",
    "Noto Sans", "Liberation Sans", Arial, sans-serif;
  font-variant-numeric: tabular-nums; overflow-wrap: break-word;
}
h1, h2, h3 { line-height: 1.2; font-weight: 600; text-wrap: balance; }
h1 { margin: 0; font-size: clamp(1.75rem, 1.3rem + 2vw, 2.6rem); letter-spacing: -0.015em; }
h2 { margin: 0 0 1.25rem; padding-top: 1.1rem; border-top: 1px solid var(--rule); font-size: 1.45rem; }
h2 { letter-spacing: -0.01em; }
h3 { margin: 0 0 0.75rem; font-size: 1.02rem; }
p, ul { margin: 0 0 1.1rem; max-width: 42rem; }
ul { padding-left: 1.2rem; }
li { margin-bottom: 0.3rem; }
a { color: var(--accent); text-decoration-thickness: 1px; text-underline-offset: 0.2em; }
a:focus-visible, summary:focus-visible, .scroll:focus-visible { outline: 2px solid var(--accent); outline-offset: 3px; }
.subtitle { margin: 0.6rem 0 0; color: var(--muted); font-size: 1.1rem; }
nav { position: sticky; top: 0; z-index: 2; margin: 2rem 0 0; background: var(--paper); }
nav ul {
  display: flex; flex-wrap: wrap; gap: 0.1rem 1.05rem; margin: 0; padding: 0.4rem 0; max-width: none; list-style: none;
  border-bottom: 1px solid var(--rule); font-size: 0.88rem;
}
nav li { margin: 0; }
nav a { display: inline-block; padding: 0.25rem 0; }
.facts { display: grid; gap: 1.6rem 1.5rem; margin: 2.4rem 0 0; }
/* The first tile is twice as wide where the last one would stand alone in its row. */
@media (max-width: 39.99rem) {
  .facts { grid-template-columns: repeat(2, minmax(0, 1fr)); }
  .facts > :first-child:nth-last-child(2n + 1) { grid-column: span 2; }
}
@media (min-width: 40rem) and (max-width: 63.99rem) {
  .facts { grid-template-columns: repeat(4, minmax(0, 1fr)); }
  .facts > :first-child:nth-last-child(4n + 1) { grid-column: span 2; }
}
@media (min-width: 64rem) {
  .facts { grid-template-columns: repeat(6, minmax(0, 1fr)); }
  .facts > :first-child:nth-last-child(6n + 1) { grid-column: span 2; }
}
.facts div { padding-top: 0.7rem; border-top: 2px solid var(--ink); }
.facts dt { color: var(--muted); font-size: 0.9rem; line-height: 1.35; }
.facts dd { margin: 0; }
.facts .value { font-size: 1.7rem; line-height: 1.35; letter-spacing: -0.01em; white-space: nowrap; }
.facts .unit { font-size: 1rem; letter-spacing: 0; }
.facts .remark { color: var(--muted); font-size: 0.85rem; line-height: 1.35; }
section { margin-top: 3.6rem; }
h2, .figure { scroll-margin-top: 5rem; }
.note { padding: 0.1rem 0 0.1rem 1rem; border-left: 3px solid var(--accent); }
.row {
  display: grid; grid-template-columns: minmax(0, 1fr); gap: 2.8rem clamp(1.8rem, 4vw, 3rem); margin: 0 0 2.4rem;
}
p + .row, ul + .row { margin-top: 2rem; }
@media (min-width: 48rem) { .row { grid-template-columns: minmax(0, 1fr) minmax(0, 1fr); } }
@media (min-width: 64rem) { .row:has(> :nth-child(3):last-child) { grid-template-columns: repeat(3, minmax(0, 1fr)); } }
@media print, (min-width: 48rem) {  /* a table alone in its row takes the width that it needs */
  .row:has(> .table:only-child) { grid-template-columns: minmax(0, 1fr); }
  .row:has(> .table:only-child) table { width: auto; min-width: 50%; }
}
.row > * { min-width: 0; }
figure { margin: 0; }
figcaption { margin-top: 0.6rem; color: var(--muted); font-size: 0.9rem; line-height: 1.45; }
.table { margin: 0 0 2.4rem; }
.row .table { margin: 0; }
.scroll { overflow-x: auto; }
.scroll tr > :first-child { position: sticky; left: 0; background: var(--paper); }
table { border-collapse: collapse; font-size: 0.92rem; line-height: 1.35; }
.row table { width: 100%; }
caption { padding-bottom: 0.6rem; font-weight: 600; font-size: 1.02rem; text-align: left; }
th, td {
  padding: 0.38rem 0.9rem 0.38rem 0; text-align: left; vertical-align: baseline; border-bottom: 1px solid var(--rule);
}
th:last-child, td:last-child { padding-right: 0; }
thead th { color: var(--muted); font-weight: 500; vertical-align: bottom; border-bottom-color: var(--axis); }
tbody th { font-weight: 400; }
.row .scroll[role] tbody th { white-space: nowrap; }
th.number, td.number { text-align: right; }
td.number, tbody th.number { white-space: nowrap; }
thead .unit { display: block; font-weight: 400; }
.table:has(> details) { margin: 0 0 0.6rem; }
summary { padding: 0.4rem 0; cursor: pointer; font-weight: 600; }
details caption { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); padding: 0; }
.read-out {
  position: absolute; z-index: 3; padding: 0.3rem 0.55rem; border: 1px solid var(--axis); border-radius: 3px;
  background: var(--paper); color: var(--ink); font-size: 0.85rem; line-height: 1.4; white-space: pre;
  pointer-events: none;
}
footer {
  margin-top: 4rem; padding-top: 1.1rem; border-top: 1px solid var(--rule); color: var(--muted); font-size: 0.9rem;
}
@media (max-width: 30rem) {
  body { padding-top: 2rem; }
  section { margin-top: 2.8rem; }
  nav ul { flex-wrap: nowrap; overflow-x: auto; white-space: nowrap; }
  .facts { gap: 1.2rem 1rem; }
  .facts .value { font-size: 1.45rem; }
}
@page { margin: 12mm 14mm; }
@media print {
  :root { --paper: #ffffff; color-scheme: light; }
  body { padding: 0; max-width: none; font-size: 10pt; line-height: 1.4; }
  p, ul { margin-bottom: 0.6rem; } li { margin-bottom: 0.1rem; }
  nav, .read-out, footer { display: none; }  /* the footer's file is in the command under Method */
  section { margin-top: 1.4rem; }
  h2 { margin-bottom: 0.8rem; padding-top: 0.7rem; } h3 { margin-bottom: 0.3rem; }
  .row:not(:has(> .table:only-child)) { grid-template-columns: 1fr 1fr; }
  .row { gap: 0.6rem 1.8rem; margin-bottom: 0.8rem; } p + .row, ul + .row { margin-top: 0.9rem; }
  figure .plot { width: 84%; }  /* three rows and their headings to a page of letter paper */
  figcaption { margin-top: 0.2rem; font-size: 8.5pt; } .table { margin-bottom: 1.1rem; }
  .scroll { overflow: visible; }
  table { font-size: 8.5pt; } th, td { padding-top: 0.18rem; padding-bottom: 0.18rem; }
  .row :is(th, td):not(:last-child) { padding-right: 0.5rem; }
  .facts { grid-template-columns: repeat(6, minmax(0, 1fr)); gap: 0.8rem 0.9rem; margin-top: 1.2rem; }
  .facts > :first-child:nth-last-child(n) { grid-column: auto; }
  .facts > :first-child:nth-last-child(6n + 1) { grid-column: span 2; }
  .facts div { padding-top: 0.4rem; border-top-width: 1pt; }
  .facts dt, .facts .remark { font-size: 7.5pt; } .facts .value { font-size: 12pt; }
  .facts .unit { font-size: 8.5pt; }
  figure, p, li, tr, .facts, .table:not(:has(tr:nth-child(31))) { break-inside: avoid; }
  h2, h3, caption, p:has(+ .row), p:has(+ p + .row), ul:has(+ .row) { break-after: avoid; }
  .plot .hair { display: none; }
  .table:has(> details:not([open])) { display: none; }
  .plot * { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
}
)css";

class Document {
 public:
  explicit Document(const Page& page) : page_{page} {}

  std::string html() {
    const std::string title = escape(page_.title);
    out_ = "<!DOCTYPE html>\n<html lang=\"" + escape(page_.language) + "\">\n<head>\n<meta charset=\"utf-8\"/>\n";
    out_ += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n";
    out_ += "<meta name=\"color-scheme\" content=\"light dark\"/>\n";
    out_ += std::string("<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src ") +
            "'unsafe-inline'; img-src data:; script-src 'sha256-" + kReadOutHash + "'\"/>\n";
    out_ += "<link rel=\"icon\" href=\"data:,\"/>\n";  // else browsers ask a server for one
    out_ += "<title>" + title + "</title>\n<style>\n";
    out_ += plot_style();
    out_ += kStyle;
    out_ += "</style>\n</head>\n<body>\n<header>\n<h1>" + title + "</h1>\n";
    if (!page_.subtitle.empty()) out_ += "<p class=\"subtitle\">" + escape(page_.subtitle) + "</p>\n";
    std::vector<std::string> ids;
    for (const Section& section : page_.sections)
      ids.push_back(unique_id(section.id.empty() ? section.title : section.id));
    if (!page_.facts.empty()) facts();
    out_ += "</header>\n";
    if (ids.size() > 1) contents(ids);
    out_ += "<main>\n";
    for (std::size_t i = 0; i < ids.size(); ++i) section(page_.sections[i], ids[i]);
    out_ += "</main>\n";
    if (!page_.footer.empty()) out_ += "<footer>" + escape(page_.footer) + "</footer>\n";
    out_ += "<script>";
    out_ += read_out_script();
    out_ += "</script>\n</body>\n</html>\n";
    return std::move(out_);
  }

 private:
  /// An id of letters, digits and dashes that starts with a letter and is unique on this page, also with the suffixes
  /// of plot.hpp.
  std::string unique_id(const std::string& wish) {
    std::string id;
    for (const char c : wish) {
      if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'))
        id += c;
      else if (c >= 'A' && c <= 'Z')
        id += static_cast<char>(c - 'A' + 'a');
      else if (!id.empty() && id.back() != '-')
        id += '-';
    }
    while (!id.empty() && id.back() == '-') id.pop_back();
    if (id.empty() || (id[0] >= '0' && id[0] <= '9')) id.insert(0, id.empty() ? "part" : "part-");
    const std::string stem = id;
    const auto taken = [this](const std::string& name) {
      if (ids_.count(name) != 0) return true;
      return std::any_of(std::begin(kSuffixes), std::end(kSuffixes),
                         [&](const char* suffix) { return ids_.count(name + suffix) != 0; });
    };
    for (int n = 2; taken(id); ++n) id = stem + '-' + std::to_string(n);
    ids_.insert(id);
    for (const char* suffix : kSuffixes) ids_.insert(id + suffix);
    return id;
  }

  void contents(const std::vector<std::string>& ids) {
    out_ += "<nav aria-label=\"Contents\">\n<ul>\n";
    for (std::size_t i = 0; i < ids.size(); ++i) {
      out_ += "<li><a href=\"#" + ids[i] + "\">" + escape(page_.sections[i].title) + "</a></li>\n";
    }
    out_ += "</ul>\n</nav>\n";
  }

  void facts() {
    out_ += "<dl class=\"facts\">\n";
    for (const Fact& fact : page_.facts) {
      out_ += "<div><dt>" + escape(fact.name) + "</dt><dd class=\"value\">" + escape(fact.value);
      if (!fact.unit.empty()) out_ += " <span class=\"unit\">" + escape(fact.unit) + "</span>";
      out_ += "</dd>";
      if (!fact.note.empty()) out_ += "<dd class=\"remark\">" + escape(fact.note) + "</dd>";
      out_ += "</div>\n";
    }
    out_ += "</dl>\n";
  }

  static bool takes_half(const Block& block) {
    const auto* table = std::get_if<Table>(&block);
    if (table != nullptr) return !table->folded && table->columns.size() <= kHalfColumns;
    return std::holds_alternative<Plot>(block);
  }

  void section(const Section& section, const std::string& id) {
    out_ += "<section aria-labelledby=\"" + id + "\">\n<h2 id=\"" + id + "\">" + escape(section.title) + "</h2>\n";
    bool row = false;
    for (const Block& block : section.blocks) {
      const bool half = takes_half(block);
      if (row && !half) out_ += "</div>\n";
      if (!row && half) out_ += "<div class=\"row\">\n";
      row = half;
      std::visit([this](const auto& content) { write(content); }, block);
    }
    if (row) out_ += "</div>\n";
    out_ += "</section>\n";
  }

  void write(const Paragraph& paragraph) {
    out_ += (paragraph.note ? "<p class=\"note\">" : "<p>") + escape(paragraph.text) + "</p>\n";
  }

  void write(const List& list) {
    if (list.items.empty()) return;
    out_ += "<ul>\n";
    for (const std::string& item : list.items) out_ += "<li>" + escape(item) + "</li>\n";
    out_ += "</ul>\n";
  }

  void write(const Plot& plot) {
    Plot drawn = plot;
    drawn.id = unique_id(plot.id.empty() ? plot.title : plot.id);
    out_ += "<figure class=\"figure\" id=\"" + drawn.id + "\">\n<h3>" + escape(plot.title) + "</h3>\n" + to_svg(drawn);
    if (!plot.caption.empty()) out_ += "<figcaption>" + escape(plot.caption) + "</figcaption>\n";
    out_ += "</figure>\n";
  }

  void write(const Table& table) {
    const std::string id = unique_id(table.caption.empty() ? "table" : table.caption);
    const std::string caption = escape(table.caption);
    out_ += "<div class=\"table\">\n";
    if (table.folded) out_ += "<details>\n<summary>" + caption + "</summary>\n";
    // A wide table must be scrollable without a mouse: make it a region that takes the focus.
    const bool wide = table.columns.size() > kNarrowColumns;
    out_ += "<div class=\"scroll\"";
    if (wide) out_ += " role=\"region\" tabindex=\"0\" aria-labelledby=\"" + id + '"';
    out_ += ">\n<table>\n";
    out_ += "<caption id=\"" + id + "\">" + caption + "</caption>\n<thead>\n<tr>";
    for (const Column& column : table.columns) {
      out_ += "<th scope=\"col\"" + css_class(column) + '>' + escape(column.title);
      if (!column.unit.empty()) out_ += " <span class=\"unit\">" + escape(column.unit) + "</span>";
      out_ += "</th>";
    }
    out_ += "</tr>\n</thead>\n<tbody>\n";
    for (const std::vector<std::string>& row : table.rows) {
      out_ += "<tr>";
      for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const std::string cell = i < row.size() ? escape(row[i]) : std::string{};
        const std::string kind = css_class(table.columns[i]);
        out_ += i == 0 ? "<th scope=\"row\"" + kind + '>' + cell + "</th>" : "<td" + kind + '>' + cell + "</td>";
      }
      out_ += "</tr>\n";
    }
    out_ += "</tbody>\n</table>\n</div>\n";
    if (table.folded) out_ += "</details>\n";
    out_ += "</div>\n";
  }

  static std::string css_class(const Column& column) { return column.numeric ? " class=\"number\"" : ""; }

  static constexpr const char* kSuffixes[] = {"-title", "-desc", "-clip"};

  const Page& page_;
  std::set<std::string> ids_{};
  std::string out_{};
};

}  // namespace

void put_first(Page& page, const std::vector<std::string>& notes) {
  if (page.sections.empty()) return;
  std::vector<Block>& first = page.sections.front().blocks;
  for (std::size_t i = 0; i < notes.size(); ++i)
    first.insert(first.begin() + static_cast<std::ptrdiff_t>(i), Paragraph{notes[i], true});
}

std::string to_html(const Page& page) { return Document{page}.html(); }

}  // namespace crankloop::report
