// SPDX-License-Identifier: Apache-2.0
#include "renderer/scene/check.h"

#include <algorithm>
#include <cmath>

#include "renderer/scene/describe.h"

namespace tilelight {
namespace {

// A mesh of wrong numbers must not crowd out the other errors.
constexpr int kMaxErrorsInList = 5;

std::string with_article(std::string_view noun) {
  const bool has_vowel = std::string_view("aeiou").find(noun.front()) != std::string_view::npos;
  return (has_vowel ? "an " : "a ") + std::string(noun);
}

bool is_in_range(double number, const Range& range) {
  if (number < range.min || (range.above_min && number == range.min)) return false;
  if (number > range.max || (range.below_max && number == range.max)) return false;
  if (range.nonzero && number == 0.0) return false;
  return !range.whole || std::floor(number) == number;
}

Complaint range_complaint(double number, const Range& range) {
  const bool over_limit = range.is_limit && number > range.max;
  return {over_limit ? "limit" : "out_of_range",
          "found " + number_text(number) + "; allowed: " + describe_range(range),
          {},
          ""};
}

// Whether a value is of the JSON kind, and of the shape among equal kinds, that the rule speaks of.
bool is_of_kind(Value value, const Rule& rule) {
  switch (rule.form) {
    case Form::boolean:
      return value.is(JsonKind::boolean);
    case Form::number:
      return value.is(JsonKind::number);
    case Form::text:
    case Form::hex_color:
    case Form::word:
      return value.is(JsonKind::text);
    case Form::numbers:
    case Form::list:
      return value.is(JsonKind::array);
    case Form::map:
    case Form::record:
    case Form::tagged:
      return value.is(JsonKind::object);
    case Form::any_of:
      return std::any_of(rule.options.begin(), rule.options.end(),
                         [value](const Rule& option) { return is_of_kind(value, option); });
  }
  return false;
}

bool is_hex_color(std::string_view text) {
  return text.size() == 7 && text[0] == '#' && text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
}

class GrammarCheck {
 public:
  explicit GrammarCheck(Problems& problems) : problems_(problems) {}

  void check(Value value, const Rule& rule) {
    if (problems_.full()) return;
    if (!is_of_kind(value, rule)) {
      refuse(value, {"wrong_type", "found " + describe_found(value) + "; allowed: " + describe_allowed(rule), {}, ""});
      return;
    }
    switch (rule.form) {
      case Form::boolean:
        break;
      case Form::number:
        if (!is_in_range(value.number(), rule.range)) refuse(value, range_complaint(value.number(), rule.range));
        break;
      case Form::numbers:
        check_numbers(value, rule);
        break;
      case Form::text:
        break;
      case Form::hex_color:
        if (!is_hex_color(value.text())) {
          refuse(value,
                 {"wrong_type", "found " + describe_found(value) + "; allowed: " + describe_allowed(rule), {}, ""});
        }
        break;
      case Form::word:
        check_word(value, rule);
        break;
      case Form::list:
        check_list(value, rule);
        break;
      case Form::map:
        check_map(value, rule);
        break;
      case Form::record:
        check_record(value, *rule.records[0], false);
        break;
      case Form::tagged:
        check_tagged(value, rule);
        break;
      case Form::any_of:
        check(value, *std::find_if(rule.options.begin(), rule.options.end(),
                                   [value](const Rule& option) { return is_of_kind(value, option); }));
        break;
    }
  }

  // `tagged`: the record was chosen by its "type", which has been seen to.
  void check_record(Value value, const Record& record, bool tagged) {
    for (const Value member : value.children()) {
      if (problems_.full()) return;  // a complaint costs its words, also if nobody hears it
      if (is_free_key(member.key()) || (tagged && member.key() == "type")) continue;
      const auto field = std::find_if(record.fields.begin(), record.fields.end(),
                                      [member](const Field& f) { return f.key == member.key(); });
      if (field == record.fields.end()) {
        refuse_key(member, unknown_key(member.key(), record, tagged));
      } else if (field->need == Need::later) {
        refuse_key(member, {"not_in_this_release",
                            in_quotes(member.key()) + " is of the language, but this release cannot do it yet",
                            {},
                            "leave it out"});
      } else {
        check(member, field->rule);
      }
    }
    check_presence(value, record);
    check_exclusive(value, record);
  }

 private:
  void refuse(Value value, Complaint complaint) {
    value.reject();
    problems_.add(value, std::move(complaint));
  }

  void refuse_key(Value member, Complaint complaint) {
    member.reject();
    problems_.add_key(member, std::move(complaint));
  }

  static Complaint unknown_key(std::string_view key, const Record& record, bool tagged) {
    std::vector<std::string> known;
    if (tagged) known.emplace_back("type");
    for (const Field& field : record.fields) {
      if (field.need != Need::later) known.emplace_back(field.key);
    }
    std::string hint = did_you_mean(key, known);
    if (hint.empty()) hint = "keys of your own begin with \"x-\" or go into \"extras\"";
    return {"unknown_key",
            "found " + in_quotes(key) + "; allowed in " + with_article(record.name) + ": " + join_words(known),
            std::move(known), std::move(hint)};
  }

  void check_presence(Value value, const Record& record) {
    const bool has_later = std::any_of(record.fields.begin(), record.fields.end(), [value](const Field& field) {
      return field.need == Need::later && value.find(field.key);
    });
    if (has_later) return;  // it may stand for what is missing
    for (const Field& field : record.fields) {
      if (field.need != Need::required || value.find(field.key)) continue;
      refuse(value, {"missing_key",
                     "found no " + in_quotes(field.key) + " in this " + std::string(record.name) + "; it is " +
                         describe_allowed(field.rule),
                     {std::string(field.key)},
                     ""});
    }
  }

  void check_exclusive(Value value, const Record& record) {
    for (const auto& keys : record.exclusive) {
      if (!value.find(keys[0])) continue;
      for (size_t i = 1; i < keys.size(); ++i) {
        if (const Value other = value.find(keys[i])) {
          refuse_key(other, {"exclusive_keys",
                             in_quotes(keys[0]) + " and " + in_quotes(keys[i]) + " exclude each other",
                             {},
                             "leave one of them out"});
        }
      }
    }
  }

  void check_word(Value value, const Rule& rule) {
    if (std::find(rule.words.begin(), rule.words.end(), value.text()) != rule.words.end()) return;
    std::vector<std::string> allowed(rule.words.begin(), rule.words.end());
    std::string hint = did_you_mean(value.text(), allowed);
    refuse(value, {"unknown_word", "found " + in_quotes(value.text()) + "; allowed: " + join_words(allowed), allowed,
                   std::move(hint)});
  }

  // Returns false, after a complaint, if `size` is not allowed.
  bool check_length(Value value, size_t size, const Length& length, const std::string& noun) {
    const auto count = static_cast<int64_t>(size);
    if (count >= length.min && count <= length.max && count % length.step == 0) return true;
    const bool over_limit = length.is_limit && count > length.max;
    refuse(value, {over_limit ? "limit" : "wrong_length",
                   "found " + describe_found(value) + "; allowed: " + describe_length(length, noun),
                   {},
                   ""});
    return false;
  }

  void check_numbers(Value value, const Rule& rule) {
    if (!value.is_packed() || (value.has_rows() && !rule.or_rows)) {
      check_entries_of_numbers(value, rule);
      if (rule.or_rows) return;  // lists have been found among its entries, so that their number says nothing
    } else {
      check_packed(value, rule.range);
    }
    const size_t size = value.is_packed() && rule.or_rows ? value.numbers().size() : value.size();
    if (!check_length(value, size, rule.length, "numbers") || value.is_rejected()) return;
    const auto numbers = value.numbers();
    if (rule.nonzero_vector && std::all_of(numbers.begin(), numbers.end(), [](double x) { return x == 0.0; })) {
      refuse(value, {"out_of_range", "found a zero vector; allowed: " + describe_allowed(rule), {}, ""});
    }
  }

  // Of an array that holds something else than it may: each entry must be as the first one, if that may be in it.
  void check_entries_of_numbers(Value value, const Rule& rule) {
    value.reject();
    if (value.has_rows()) return refuse_rows(value, describe_range(rule.range));
    const bool by_rows = rule.or_rows && (*value.children().begin()).is(JsonKind::array);
    const int64_t each = Document::kRowNumbers;
    const Rule entry_rule = by_rows ? Rule{.form = Form::numbers, .range = rule.range, .length = {each, each}}
                                    : Rule{.form = Form::number, .range = rule.range};
    int errors = 0;
    for (const Value entry : value.children()) {
      check(entry, entry_rule);
      if (entry.is_rejected() && ++errors == kMaxErrorsInList) break;
    }
  }

  // Each row of a packed array where there may be none.
  void refuse_rows(Value value, const std::string& allowed) {
    for (size_t i = 0; i < std::min<size_t>(value.size(), kMaxErrorsInList); ++i)
      problems_.add_row(value, i, {"wrong_type", "found a list of 3 numbers; allowed: " + allowed, {}, ""});
  }

  void check_packed(Value value, const Range& range) {
    const auto numbers = value.numbers();
    int errors = 0;
    for (size_t i = 0; i < numbers.size() && errors < kMaxErrorsInList; ++i) {
      if (is_in_range(numbers[i], range)) continue;
      value.reject();
      problems_.add_element(value, i, range_complaint(numbers[i], range));
      ++errors;
    }
  }

  void check_list(Value value, const Rule& rule) {
    if (!check_length(value, value.size(), rule.length, "entries")) return;
    if (value.has_rows()) {
      value.reject();
      refuse_rows(value, describe_allowed(rule.options[0]));
    } else if (value.is_packed() && value.size() > 0) {
      value.reject();
      for (size_t i = 0; i < std::min<size_t>(value.size(), kMaxErrorsInList); ++i) {
        problems_.add_element(
            value, i,
            {"wrong_type",
             "found " + number_text(value.numbers()[i]) + "; allowed: " + describe_allowed(rule.options[0]),
             {},
             ""});
      }
    }
    for (const Value entry : value.children()) check(entry, rule.options[0]);
  }

  void check_map(Value value, const Rule& rule) {
    if (!check_length(value, value.size(), rule.length, "entries")) return;
    for (const Value entry : value.children()) {
      if (!is_free_key(entry.key())) check(entry, rule.options[0]);
    }
  }

  void check_tagged(Value value, const Rule& rule) {
    std::vector<std::string_view> words;
    for (const auto& record : rule.records) words.push_back(record->name);
    const Rule tag_rule{.form = Form::word, .words = std::move(words)};
    const Value tag = value.find("type");
    if (!tag && !rule.tag_optional) {
      const std::vector<std::string> allowed(tag_rule.words.begin(), tag_rule.words.end());
      refuse(value, {"missing_key", "found no \"type\"; allowed: " + join_words(allowed), allowed, ""});
      return;
    }
    if (tag) check(tag, tag_rule);
    if (tag && tag.is_rejected()) {
      value.reject();
      return;
    }
    const auto record = tag ? std::find_if(rule.records.begin(), rule.records.end(),
                                           [tag](const auto& r) { return r->name == tag.text(); })
                            : rule.records.begin();
    check_record(value, **record, true);
  }

  Problems& problems_;
};

}  // namespace

void report_duplicates(Document& document, Problems& problems) {
  for (const Value member : document.duplicates()) {
    if (problems.full()) return;
    problems.add_key(member, {"duplicate_key",
                              "found " + in_quotes(member.key()) + " more than once in one object",
                              {},
                              "leave one of them out"});
  }
}

void check_document(Value root, const Record& grammar, Problems& problems) {
  if (!root.is(JsonKind::object)) {
    root.reject();
    problems.add(
        root, {"wrong_type",
               "found " + describe_found(root) + "; allowed: a " + std::string(grammar.name) + ", which is an object",
               {},
               ""});
    return;
  }
  GrammarCheck(problems).check_record(root, grammar, false);
}

}  // namespace tilelight
