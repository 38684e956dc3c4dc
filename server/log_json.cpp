// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "renderer/base/characters.h"
#include "server/log.h"

namespace tilelight::server {

std::string log_line_json(std::string_view time, std::string_view level, std::string_view event, Log::Fields fields) {
  nlohmann::ordered_json line = {{"time", time}, {"level", level}, {"event", event}};
  for (const auto& [name, value] : fields) {
    if (const auto* text = std::get_if<std::string>(&value)) {
      line[std::string(name)] = cut_log_value(*text);
    } else {
      std::visit([&, key = std::string(name)](const auto& v) { line[key] = v; }, value);
    }
  }
  // Invalid UTF-8 from a client becomes U+FFFD instead of an exception.
  return printable_json(line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

}  // namespace tilelight::server
