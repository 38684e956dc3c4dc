// SPDX-License-Identifier: Apache-2.0
#include "renderer/scene/document.h"

#include <algorithm>
#include <tuple>

namespace tilelight {

Value Document::root() { return {this, 0}; }

std::vector<Value> Document::duplicates() {
  std::vector<Value> values;
  for (const uint32_t index : duplicates_) values.push_back({this, index});
  return values;
}

std::string_view Value::text() const { return std::string_view(document_->chars_).substr(node().begin, node().size); }

std::span<const double> Value::numbers() const {
  const size_t each = node().has_rows ? Document::kRowNumbers : 1;
  return std::span(document_->numbers_).subspan(node().begin, each * node().size);
}

std::string_view Value::key() const {
  return std::string_view(document_->chars_).substr(node().key_begin, node().key_size);
}

Value::Children Value::children() const { return {document_, node().packed ? 0 : node().begin}; }

Value Value::find(std::string_view key) const {
  Value found;
  if (!is(JsonKind::object)) return found;
  for (const Value member : children()) {
    if (member.key() == key) found = member;
  }
  return found;
}

std::string Value::pointer() const {
  std::string pointer;
  for (uint32_t index = index_; index != 0;) {
    const Document::Node& node = document_->nodes_[index];
    const Value parent(document_, node.parent);
    if (parent.is(JsonKind::object)) {
      pointer = pointer_token(Value(document_, index).key()) + pointer;
    } else if (parent.is_packed()) {  // an array that is still open, and perhaps its next row
      pointer.insert(0, pointer_token(std::to_string(parent.size())));
    } else {
      size_t place = 0;
      for (uint32_t i = parent.node().begin; i != index; i = document_->nodes_[i].next) ++place;
      pointer.insert(0, pointer_token(std::to_string(place)));
    }
    index = node.parent;
  }
  return pointer;
}

std::string Value::number_pointer(size_t index) const {
  if (!has_rows()) return pointer() + "/" + std::to_string(index);
  return pointer() + "/" + std::to_string(index / Document::kRowNumbers) + "/" +
         std::to_string(index % Document::kRowNumbers);
}

std::string pointer_token(std::string_view key) {
  std::string token = "/";
  for (const char c : key) {
    if (c == '~') {
      token += "~0";
    } else if (c == '/') {
      token += "~1";
    } else {
      token += c;
    }
  }
  return token;
}

bool DocumentBuilder::open(JsonKind array_or_object) {
  const bool is_maybe_row = array_or_object == JsonKind::array && may_hold_rows();
  if (!add_node(array_or_object)) return false;
  const auto index = static_cast<uint32_t>(document_.nodes_.size() - 1);
  if (!is_maybe_row && !link(index)) return false;
  Document::Node& node = document_.nodes_[index];
  node.parent = open_.empty() ? 0 : open_.back().node;
  node.packed = array_or_object == JsonKind::array;
  node.begin = node.packed ? static_cast<uint32_t>(document_.numbers_.size()) : 0;
  open_.push_back({index, 0, is_maybe_row});
  return true;
}

bool DocumentBuilder::close() {
  const Open closed = open_.back();
  open_.pop_back();
  const Document::Node& node = document_.nodes_[closed.node];
  if (node.kind == JsonKind::object) find_duplicates(closed.node);
  if (!closed.is_maybe_row) return true;
  if (!node.packed || node.has_rows || node.size != Document::kRowNumbers) return link(closed.node);
  // A row: the last node, for it has none inside, and its numbers follow those of the rows before it.
  document_.nodes_.pop_back();
  Document::Node& array = document_.nodes_[open_.back().node];
  array.has_rows = true;
  ++array.size;
  return true;
}

void DocumentBuilder::key(std::string_view key) {
  key_begin_ = static_cast<uint32_t>(document_.chars_.size());
  key_size_ = static_cast<uint32_t>(key.size());
  document_.chars_ += key;
}

bool DocumentBuilder::add(JsonKind null_or_boolean, bool value) {
  if (!add_node(null_or_boolean)) return false;
  document_.nodes_.back().number = value ? 1.0 : 0.0;
  return link_last();
}

bool DocumentBuilder::add_number(double value) {
  if (!open_.empty()) {
    Document::Node& parent = document_.nodes_[open_.back().node];
    if (parent.packed && !parent.has_rows) {
      document_.numbers_.push_back(value);
      ++parent.size;
      return true;
    }
  }
  if (!add_node(JsonKind::number)) return false;
  document_.nodes_.back().number = value;
  return link_last();
}

bool DocumentBuilder::add_text(std::string_view text) {
  if (!add_node(JsonKind::text)) return false;
  Document::Node& node = document_.nodes_.back();
  node.begin = static_cast<uint32_t>(document_.chars_.size());
  node.size = static_cast<uint32_t>(text.size());
  document_.chars_ += text;
  return link_last();
}

// Whether the innermost open container is an array of rows so far, or empty.
bool DocumentBuilder::may_hold_rows() const {
  if (open_.empty()) return false;
  const Document::Node& node = document_.nodes_[open_.back().node];
  return node.packed && (node.has_rows || node.size == 0);
}

bool DocumentBuilder::add_node(JsonKind kind) {
  if (document_.nodes_.size() >= max_values_) return false;
  document_.nodes_.emplace_back().kind = kind;
  return true;
}

// Makes a node the next child of the innermost open container.
bool DocumentBuilder::link(uint32_t index) {
  if (open_.empty()) return true;
  if (!unpack()) return false;
  auto& [parent, last_child, is_maybe_row] = open_.back();
  Document::Node& node = document_.nodes_[index];
  node.parent = parent;
  node.key_begin = key_begin_;
  node.key_size = key_size_;
  (last_child == 0 ? document_.nodes_[parent].begin : document_.nodes_[last_child].next) = index;
  last_child = index;
  ++document_.nodes_[parent].size;
  return true;
}

// The innermost open array began with numbers, or with rows of them, and holds something else: they become nodes.
bool DocumentBuilder::unpack() {
  Document::Node& array = document_.nodes_[open_.back().node];
  if (!array.packed) return true;
  const auto [begin, size, had_rows] = std::tuple(array.begin, array.size, array.has_rows);
  array.packed = array.has_rows = false;
  array.begin = array.size = 0;
  if (had_rows) return unpack_rows(begin, size);
  for (uint32_t i = 0; i < size; ++i) {
    if (!add_number(document_.numbers_[begin + i])) return false;
  }
  return true;
}

// Their numbers stay where they are.
bool DocumentBuilder::unpack_rows(uint32_t begin, uint32_t count) {
  for (uint32_t i = 0; i < count; ++i) {
    if (!add_node(JsonKind::array)) return false;
    Document::Node& row = document_.nodes_.back();
    row.packed = true;
    row.begin = begin + i * Document::kRowNumbers;
    row.size = Document::kRowNumbers;
    if (!link_last()) return false;
  }
  return true;
}

void DocumentBuilder::find_duplicates(uint32_t object) {
  std::vector<Value> members;
  members.reserve(document_.nodes_[object].size);
  for (uint32_t i = document_.nodes_[object].begin; i != 0; i = document_.nodes_[i].next) {
    members.push_back(Value(&document_, i));
  }
  std::stable_sort(members.begin(), members.end(), [](Value a, Value b) { return a.key() < b.key(); });
  for (size_t i = 1; i < members.size(); ++i) {
    const bool is_last = i + 1 == members.size() || members[i + 1].key() != members[i].key();
    if (is_last && members[i].key() == members[i - 1].key()) document_.duplicates_.push_back(members[i].index_);
  }
}

std::string DocumentBuilder::next_pointer() {
  if (open_.empty()) return "";
  const uint32_t parent = open_.back().node;
  const Document::Node& node = document_.nodes_[parent];
  const std::string token = node.kind == JsonKind::object
                                ? pointer_token(std::string_view(document_.chars_).substr(key_begin_, key_size_))
                                : pointer_token(std::to_string(node.size));
  return Value(&document_, parent).pointer() + token;
}

}  // namespace tilelight
