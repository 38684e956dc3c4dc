// SPDX-License-Identifier: Apache-2.0
#include "renderer/scene/canonical.h"

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

#include "renderer/base/hash.h"
#include "renderer/scene/grammar.h"

namespace tilelight {
namespace {

// Kinds of values in the serialisation. Stored in identities: never renumber.
enum class Tag : char {
  null = 'z',
  no = 'f',
  yes = 't',
  number = 'n',
  numbers = 'N',
  text = 's',
  array = 'a',
  object = 'o'
};

class Writer {
 public:
  void write(Value value) {
    switch (value.kind()) {
      case JsonKind::null:
        tag(Tag::null);
        break;
      case JsonKind::boolean:
        tag(value.boolean() ? Tag::yes : Tag::no);
        break;
      case JsonKind::number:
        tag(Tag::number);
        number(value.number());
        break;
      case JsonKind::text:
        tag(Tag::text);
        text(value.text());
        break;
      case JsonKind::array:
        write_array(value);
        break;
      case JsonKind::object:
        write_object(value);
        break;
    }
  }

  // An object with the members of which `keep` is true.
  template <class Keep>
  void write_members(Value object, Keep keep) {
    std::vector<Value> members;
    for (const Value member : object.children()) {
      if (keep(member)) members.push_back(member);
    }
    std::sort(members.begin(), members.end(), [](Value a, Value b) { return a.key() < b.key(); });
    tag(Tag::object);
    integer(members.size());
    for (const Value member : members) {
      text(member.key());
      names_are_data_ = object_depth_ == 0 && (member.key() == "materials" || member.key() == "meshes");
      ++object_depth_;
      write(member);
      --object_depth_;
    }
  }

  std::string take() { return std::move(bytes_); }

 private:
  // Under `materials` and `meshes` the keys are the user's names, and one of them may be "name".
  void write_object(Value object) {
    const bool names_are_data = std::exchange(names_are_data_, false);
    write_members(object, [names_are_data](Value member) {
      return !is_free_key(member.key()) && (names_are_data || member.key() != "name");
    });
  }

  // Numbers in a row and in rows of three mean the same.
  void write_array(Value array) {
    if (array.is_packed()) {
      const auto numbers = array.numbers();
      tag(Tag::numbers);
      integer(numbers.size());
      bytes_.reserve(bytes_.size() + 8 * numbers.size());
      for (const double x : numbers) number(x);
      return;
    }
    tag(Tag::array);
    integer(array.size());
    for (const Value element : array.children()) write(element);
  }

  void tag(Tag tag) { bytes_ += static_cast<char>(tag); }
  void number(double x) { integer(std::bit_cast<uint64_t>(x == 0.0 ? 0.0 : x)); }
  void text(std::string_view text) {
    integer(text.size());
    bytes_ += text;
  }
  void integer(uint64_t x) {  // little-endian, on every machine
    for (int shift = 0; shift < 64; shift += 8) bytes_ += static_cast<char>(x >> shift & 0xFF);
  }

  std::string bytes_;
  int object_depth_ = 0;
  bool names_are_data_ = false;
};

template <class Keep>
std::string hash_members(Value root, Keep keep) {
  Writer writer;
  writer.write_members(root, keep);
  return sha256_hex("tilelight scene 1\n" + writer.take());
}

// Which version a document says it is of goes into no identity: the absent and the present 1 are the same.
bool is_content(Value member) { return !is_free_key(member.key()) && member.key() != "tilelight"; }

}  // namespace

std::string scene_id(Value root) { return hash_members(root, is_content); }

std::string compile_key(Value root) {
  return hash_members(root, [](Value member) {
    const std::string_view key = member.key();
    return is_content(member) && key != "camera" && key != "image" && key != "render";
  });
}

}  // namespace tilelight
