// SPDX-License-Identifier: Apache-2.0
// Document: a JSON text as a compact tree of values. Nodes lie in one array and are linked by index; an array of
// numbers is one node and its doubles lie side by side, and so is an array of rows of three numbers: a mesh of two
// million numbers costs 16 MB, however it is written. Values remember their parents and can say their JSON pointer, and
// whether the grammar refused them. Not thread-safe while being checked.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tilelight {

enum class JsonKind : uint8_t { null, boolean, number, text, array, object };

class Value;

class Document {
 public:
  static constexpr uint32_t kRowNumbers = 3;

  Value root();
  // Of every name that stands more than once in one object, its last member.
  std::vector<Value> duplicates();

 private:
  friend class Value;
  friend class DocumentBuilder;

  struct Node {
    JsonKind kind = JsonKind::null;
    bool packed = false;    // an array of nothing but numbers, or but rows of them: they lie in numbers_
    bool has_rows = false;  // a packed array of rows, each an array of kRowNumbers numbers
    bool rejected = false;  // the grammar refused it
    uint32_t parent = 0;
    uint32_t next = 0;                     // the next sibling; 0 = none (the root is nobody's sibling)
    uint32_t key_begin = 0, key_size = 0;  // in chars_
    uint32_t begin = 0;                    // text: in chars_; packed: in numbers_; others: the first child
    uint32_t size = 0;                     // text: bytes; others: elements, of which a row is one
    double number = 0.0;                   // a boolean is 0 or 1
  };

  std::vector<Node> nodes_;
  std::vector<double> numbers_;
  std::string chars_;
  std::vector<uint32_t> duplicates_;
};

// A handle on one value of a Document, which must outlive it; or on none, as found under a key that is not there.
class Value {
 public:
  class Children;

  Value() = default;

  explicit operator bool() const { return document_ != nullptr; }
  JsonKind kind() const { return node().kind; }
  bool is(JsonKind kind) const { return document_ != nullptr && node().kind == kind; }
  bool is_packed() const { return node().packed; }
  bool has_rows() const { return node().has_rows; }
  size_t size() const { return node().size; }  // elements of an array or object; a row is one
  double number() const { return node().number; }
  bool boolean() const { return node().number != 0.0; }
  std::string_view text() const;
  std::span<const double> numbers() const;  // of a packed array, row after row
  std::string_view key() const;             // of a member
  Children children() const;                // of an object, or of an array that is not packed
  Value find(std::string_view key) const;   // the last member of that name

  // The grammar marks what it refuses, and everything that reads values afterwards passes it by.
  void reject() { document_->nodes_[index_].rejected = true; }
  bool is_rejected() const { return node().rejected; }

  std::string pointer() const;                     // RFC 6901
  std::string number_pointer(size_t index) const;  // of one of the numbers of a packed array

 private:
  friend class Document;
  friend class DocumentBuilder;

  Value(Document* document, uint32_t index) : document_(document), index_(index) {}
  const Document::Node& node() const { return document_->nodes_[index_]; }

  Document* document_ = nullptr;
  uint32_t index_ = 0;
};

class Value::Children {
 public:
  class Iterator {
   public:
    Iterator(Document* document, uint32_t index) : document_(document), index_(index) {}
    Value operator*() const { return {document_, index_}; }
    Iterator& operator++() {
      index_ = document_->nodes_[index_].next;
      return *this;
    }
    bool operator!=(const Iterator& other) const { return index_ != other.index_; }

   private:
    Document* document_;
    uint32_t index_;
  };

  Children(Document* document, uint32_t first) : document_(document), first_(first) {}
  Iterator begin() const { return {document_, first_}; }
  Iterator end() const { return {document_, 0}; }

 private:
  Document* document_;
  uint32_t first_;
};

// Makes a Document from the events of a JSON reader, in their order. Every call answers false once the document holds
// `max_values` values; numbers of packed arrays do not count, for the length of the text bounds them well enough.
class DocumentBuilder {
 public:
  explicit DocumentBuilder(size_t max_values) : max_values_(max_values) {}

  bool open(JsonKind array_or_object);
  bool close();
  void key(std::string_view key);
  bool add(JsonKind null_or_boolean, bool value);
  bool add_number(double value);
  bool add_text(std::string_view text);

  size_t depth() const { return open_.size(); }
  std::string next_pointer();  // of the value that would come next
  Document take() { return std::move(document_); }

 private:
  struct Open {
    uint32_t node;
    uint32_t last_child;        // 0 = none yet
    bool is_maybe_row = false;  // not linked before it closes
  };

  bool may_hold_rows() const;
  bool add_node(JsonKind kind);
  bool link(uint32_t index);
  bool link_last() { return link(static_cast<uint32_t>(document_.nodes_.size() - 1)); }
  bool unpack();
  bool unpack_rows(uint32_t begin, uint32_t count);
  void find_duplicates(uint32_t object);

  Document document_;
  size_t max_values_;
  std::vector<Open> open_;
  uint32_t key_begin_ = 0, key_size_ = 0;
};

// One token of a JSON pointer with its leading slash.
std::string pointer_token(std::string_view key);

}  // namespace tilelight
