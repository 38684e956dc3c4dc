// SPDX-License-Identifier: Apache-2.0
#include "renderer/study/html.h"

#include <cstdio>

namespace tilelight::html {
namespace {

constexpr const char* kStyle = R"(
:root { color-scheme: light; }
body { font: 15px/1.5 system-ui, sans-serif; color: #1c1c1c; background: #fff; max-width: 1060px; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.5rem; margin-bottom: .2rem; } h2 { font-size: 1.15rem; margin-top: 2.2rem; }
p.lead { color: #555; margin-top: 0; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: 13px; }
th, td { padding: .25rem .6rem; text-align: right; border-bottom: 1px solid #e4e4e4; white-space: nowrap; }
th { text-align: right; font-weight: 600; border-bottom: 2px solid #888; } th:first-child, td:first-child { text-align: left; }
tr.front td { background: #eef6ee; } tr.miss td { background: #fbeeee; } tr.own td { font-weight: 600; }
.wide { overflow-x: auto; } svg { max-width: 100%; height: auto; }
.pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(230px, 1fr)); gap: 1rem; }
.smooth img { image-rendering: auto; } .pictures + .pictures { margin-top: 1rem; } figure { margin: 0; } img { width: 100%; image-rendering: pixelated; background: #000; } figcaption { font-size: 13px; color: #555; }
)";

std::string row(const Cells& cells, const std::string& tag, const std::string& css = "") {
  std::string out = css.empty() ? "<tr>" : "<tr class=\"" + css + "\">";
  for (const std::string& cell : cells) out += "<" + tag + ">" + escaped(cell) + "</" + tag + ">";
  return out + "</tr>\n";
}

}  // namespace

std::string escaped(const std::string& plain) {
  std::string out;
  for (const char c : plain) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else {
      out += c;
    }
  }
  return out;
}

std::string head(const std::string& title) {
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
         "content=\"width=device-width\"><title>" +
         escaped(title) + "</title><style>" + kStyle + "</style></head><body>\n";
}

std::string tail() { return "</body></html>\n"; }

std::string text(const char* format, double v) {
  char out[64];
  std::snprintf(out, sizeof out, format, v);
  return out;
}

std::string ms(double v) { return text(v < 10.0 ? "%.1f" : "%.0f", v); }
std::string error(double v) { return text(v >= 0.00995 ? "%.3f" : "%.2g", v); }

Table::Table(const Cells& head) : html_("<div class=\"wide\"><table><thead>" + row(head, "th") + "</thead><tbody>") {}

void Table::add(const Cells& cells, const std::string& css) { html_ += row(cells, "td", css); }

std::string Table::html() const { return html_ + "</tbody></table></div>\n"; }

std::string figure(const std::string& file, const std::string& caption) {
  return "<figure><img src=\"" + file + "\" alt=\"\"><figcaption>" + escaped(caption) + "</figcaption></figure>\n";
}

}  // namespace tilelight::html
