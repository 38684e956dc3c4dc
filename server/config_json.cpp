// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "server/config.h"

namespace tilelight::server {

Result<std::map<std::string, std::string>> read_config_file(const std::string& path) {
  std::ifstream in(path);
  if (!in) return fail("no_file", path + ": cannot be read");
  std::map<std::string, std::string> out;
  try {
    const std::string text(std::istreambuf_iterator<char>(in), {});
    // The library takes it for the end of the text.
    if (text.find('\0') != std::string::npos) return fail("not_json", path + ": found U+0000, which no JSON text has");
    const auto document = nlohmann::json::parse(text);
    if (!document.is_object()) return fail("wrong_type", path + ": expected one JSON object");
    for (const auto& [key, value] : document.items()) {
      if (value.is_string()) {
        out[key] = value.get<std::string>();
      } else if (value.is_number_integer() || value.is_boolean()) {
        out[key] = value.dump();
      } else {
        return fail("wrong_type", path + ": '" + key + "' must be a string, a whole number, true or false");
      }
    }
  } catch (const nlohmann::json::exception& error) {
    return fail("not_json", path + ": " + error.what());
  }
  return out;
}

}  // namespace tilelight::server
