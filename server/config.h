// SPDX-License-Identifier: Apache-2.0
// Config: everything an operator can set. Defaults < file (--config, JSON) < TILELIGHT_* environment < flags; one table
// names every setting for all three, and a name that is not in it refuses to start. A leaf; plain values.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/renderer.h"
#include "server/address.h"

namespace tilelight::server {

enum class LogFormat { automatic, text, json };  // automatic: text on a terminal, JSON lines otherwise

constexpr int kMaxJobRecords = 10'000;  // the oldest ended ones go; so no more results can be found again

struct Config {
  std::string host = "127.0.0.1";
  int port = 8080;  // 0: any free one
  std::string admin_host = "127.0.0.1";
  int admin_port = 8081;  // 0: any free one
  std::string data_dir = ":memory:";
  bool allow_open = false;                 // a public bind without keys
  std::vector<std::string> allowed_hosts;  // names accepted in Host beside localhost and addresses
  std::vector<Network> trusted_proxies;    // whose X-Forwarded- fields count
  int threads = 0;                         // of the tile pool; 0: one a hardware thread
  int max_queue = 256;                     // renders that wait for their start
  int max_wait_s = 40;                     // longest silence of a request that waits; proxies give up after 50 or 60
  int max_sessions = 64;
  int64_t scene_cache_mb = 1024;  // compiled scenes kept for reuse
  int64_t results_mb = 512;       // finished images kept
  int max_results = 1000;
  int64_t pictures_mb = 64;  // pictures of stored scenes kept, for caches that ask again by other headers
  int64_t films_mb = 1024;   // films of done renders kept to be refined: one of 3840x2160, nine of 1280x720
  int film_keep_s = 300;     // for so long
  std::string log_level = "info";
  LogFormat log_format = LogFormat::automatic;
  Limits limits;

  // What the hosts stand for, numeric, as load_config has checked it: what is bound, so that no second look-up can say
  // otherwise. Empty: the hosts are addresses themselves.
  std::vector<std::string> host_addresses, admin_addresses;

  // Not for operators: the server's patience, which tests shorten.
  double head_timeout_ms = 10'000.0;
  double drain_ms = 2'000.0;  // for running renders to end by themselves when the server stops
  int max_streams = 256;      // of events
  int max_waiting = 160;      // requests that wait for a render, a change or a frame
};

struct ConfigRequest {
  Config config;
  bool help_or_version = false;  // `text` says it; the program ends with 0
  std::string text;
};

// Reads file, environment and flags, and looks the hosts up. The error is a sentence for the operator.
Result<ConfigRequest> load_config(int argc, const char* const* argv,
                                  const std::map<std::string, std::string>& environment,
                                  const Resolve& resolve = resolve_host);

// The process's environment as a map.
std::map<std::string, std::string> process_environment();

// One setting of the table. Its name serves as --max-queue, TILELIGHT_MAX_QUEUE and "max_queue".
struct Setting {
  std::string_view name;
  std::string_view value_name;  // empty: a switch
  std::string_view help;
  std::function<Result<void>(Config&, const std::string&)> set;
};
const std::vector<Setting>& settings();

// A member of a configuration file, which is one flat JSON object, with its value as text.
struct ConfigMember {
  enum class Type { text, whole, truth };
  std::string key, value;
  Type type = Type::text;
  int line = 0, column = 0;  // of the key, from 1
};
// All members, in their order. Errors: no_file, not_json, wrong_type; they name the place.
Result<std::vector<ConfigMember>> read_config_file(const std::string& path);

}  // namespace tilelight::server
