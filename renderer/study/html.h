// SPDX-License-Identifier: Apache-2.0
// What the pages that are written to look at share: their head and style, tables, figures, numbers. Text is escaped.
#pragma once

#include <string>
#include <vector>

namespace tilelight::html {

std::string escaped(const std::string& plain);

// The document up to its body, and from there on.
std::string head(const std::string& title);
std::string tail();

// By a format of printf for one double.
__attribute__((format(printf, 1, 0))) std::string text(const char* format, double v);
std::string ms(double v);
std::string error(double v);

using Cells = std::vector<std::string>;

class Table {
 public:
  explicit Table(const Cells& head);
  // css: a class of the row: front, miss, own.
  void add(const Cells& cells, const std::string& css = "");
  std::string html() const;

 private:
  std::string html_;
};

// A picture beside the page.
std::string figure(const std::string& file, const std::string& caption);

}  // namespace tilelight::html
