// SPDX-License-Identifier: Apache-2.0
#include "renderer/scene/document.h"

#include <algorithm>

namespace tilelight {

Value Document::root() { return {this, 0}; }

std::vector<Value> Document::duplicates() {
  std::vector<Value> values;
  for (const uint32_t index : duplicates_) values.push_back({this, index});
  return values;
}

std::string_view Value::text() const { return std::string_view(document_->chars_).substr(node().begin, node().size); }

std::span<const double> Value::numbers() const {
  return std::span(document_->numbers_).subspan(node().begin, node().size);
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
    } else {
      size_t place = 0;
      for (uint32_t i = parent.node().begin; i != index; i = document_->nodes_[i].next) ++place;
      pointer.insert(0, pointer_token(std::to_string(place)));
    }
    index = node.parent;
  }
  return pointer;
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
  if (!link_new_node()) return false;
  const auto index = static_cast<uint32_t>(document_.nodes_.size() - 1);
  Document::Node& node = document_.nodes_[index];
  node.kind = array_or_object;
  node.packed = array_or_object == JsonKind::array;
  node.begin = node.packed ? static_cast<uint32_t>(document_.numbers_.size()) : 0;
  open_.push_back({index, 0});
  return true;
}

void DocumentBuilder::close() {
  const uint32_t index = open_.back().node;
  open_.pop_back();
  if (document_.nodes_[index].kind == JsonKind::object) find_duplicates(index);
}

void DocumentBuilder::key(std::string_view key) {
  key_begin_ = static_cast<uint32_t>(document_.chars_.size());
  key_size_ = static_cast<uint32_t>(key.size());
  document_.chars_ += key;
}

bool DocumentBuilder::add(JsonKind null_or_boolean, bool value) {
  if (!add_node(null_or_boolean)) return false;
  document_.nodes_.back().number = value ? 1.0 : 0.0;
  return true;
}

bool DocumentBuilder::add_number(double value) {
  if (!open_.empty() && document_.nodes_[open_.back().node].packed) {
    document_.numbers_.push_back(value);
    ++document_.nodes_[open_.back().node].size;
    return true;
  }
  if (!add_node(JsonKind::number)) return false;
  document_.nodes_.back().number = value;
  return true;
}

bool DocumentBuilder::add_text(std::string_view text) {
  if (!add_node(JsonKind::text)) return false;
  Document::Node& node = document_.nodes_.back();
  node.begin = static_cast<uint32_t>(document_.chars_.size());
  node.size = static_cast<uint32_t>(text.size());
  document_.chars_ += text;
  return true;
}

bool DocumentBuilder::add_node(JsonKind kind) {
  if (!link_new_node()) return false;
  document_.nodes_.back().kind = kind;
  return true;
}

// Appends a node as the next child of the innermost open container.
bool DocumentBuilder::link_new_node() {
  if (!open_.empty() && document_.nodes_[open_.back().node].packed && !unpack()) return false;
  if (document_.nodes_.size() >= max_values_) return false;
  const auto index = static_cast<uint32_t>(document_.nodes_.size());
  document_.nodes_.emplace_back();
  if (open_.empty()) return true;
  auto& [parent, last_child] = open_.back();
  Document::Node& node = document_.nodes_.back();
  node.parent = parent;
  node.key_begin = key_begin_;
  node.key_size = key_size_;
  (last_child == 0 ? document_.nodes_[parent].begin : document_.nodes_[last_child].next) = index;
  last_child = index;
  ++document_.nodes_[parent].size;
  return true;
}

// An array that began with numbers holds something else: its numbers become nodes. They are the last in numbers_, for
// nothing inside a packed array can have added others.
bool DocumentBuilder::unpack() {
  Document::Node& array = document_.nodes_[open_.back().node];
  const std::vector<double> numbers(document_.numbers_.begin() + array.begin, document_.numbers_.end());
  document_.numbers_.resize(array.begin);
  array.packed = false;
  array.begin = array.size = 0;
  return std::all_of(numbers.begin(), numbers.end(), [this](double number) { return add_number(number); });
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
