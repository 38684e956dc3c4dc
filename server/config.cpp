// SPDX-License-Identifier: Apache-2.0
#include "server/config.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <optional>

namespace tilelight::server {
namespace {

// Of host names; an underscore stands in some.
constexpr std::string_view kNameLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._";

std::string with(std::string_view name, char from, char to) {
  std::string out(name);
  std::replace(out.begin(), out.end(), from, to);
  return out;
}

std::string environment_name(const Setting& setting) {
  std::string out = "TILELIGHT_" + with(setting.name, '-', '_');
  for (char& c : out) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return out;
}

Result<int64_t> whole_number(const std::string& text, int64_t low, int64_t high) {
  int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size() && value >= low && value <= high) return value;
  return fail("bad_value",
              "'" + text + "' is not a whole number from " + std::to_string(low) + " to " + std::to_string(high));
}

template <class Int>
auto number(Int Config::*field, int64_t low, int64_t high) {
  return [=](Config& config, const std::string& text) -> Result<void> {
    return whole_number(text, low, high).map([&](int64_t value) { config.*field = static_cast<Int>(value); });
  };
}

template <class Int>
auto limit(Int Limits::*field, int64_t low, int64_t high) {
  return [=](Config& config, const std::string& text) -> Result<void> {
    return whole_number(text, low, high).map([&](int64_t value) { config.limits.*field = static_cast<Int>(value); });
  };
}

auto text_field(std::string Config::*field) {
  return [=](Config& config, const std::string& text) -> Result<void> {
    config.*field = text;
    return {};
  };
}

Result<bool> truth(const std::string& text) {
  if (text == "true" || text == "1" || text.empty()) return true;
  if (text == "false" || text == "0") return false;
  return fail("bad_value", "'" + text + "' is neither true nor false");
}

Result<void> set_allow_open(Config& config, const std::string& text) {
  return truth(text).map([&](bool value) { config.allow_open = value; });
}

Result<void> set_quiet(Config& config, const std::string& text) {
  return truth(text).map([&](bool value) {
    if (value) config.log_level = "warn";
  });
}

Result<void> set_allowed_hosts(Config& config, const std::string& text) {
  std::stringstream words(text);
  for (std::string word; std::getline(words, word, ',');) {
    if (word.empty()) continue;
    if (word.find_first_not_of(kNameLetters) != std::string::npos)
      return fail("bad_value",
                  "found '" + word + "'; allowed: names of hosts, such as render.example, without scheme, port or '*'");
    config.allowed_hosts.push_back(word);
  }
  return {};
}

Result<void> set_trusted_proxies(Config& config, const std::string& text) {
  config.trusted_proxies.clear();
  std::stringstream words(text);
  for (std::string word; std::getline(words, word, ',');) {
    const auto network = parse_network(word);
    if (!network) return ::tl::unexpected(network.error());
    config.trusted_proxies.push_back(*network);
  }
  return {};
}

Result<void> set_log_level(Config& config, const std::string& text) {
  for (const char* known : {"debug", "info", "warn", "error", "off"}) {
    if (text == known) return config.log_level = text, Result<void>{};
  }
  return fail("bad_value", "'" + text + "' is none of debug, info, warn, error, off");
}

Result<void> set_log_format(Config& config, const std::string& text) {
  if (text == "auto") return config.log_format = LogFormat::automatic, Result<void>{};
  if (text == "text") return config.log_format = LogFormat::text, Result<void>{};
  if (text == "json") return config.log_format = LogFormat::json, Result<void>{};
  return fail("bad_value", "'" + text + "' is none of auto, text, json");
}

Result<void> set_data_dir(Config& config, const std::string& text) {
  if (text != ":memory:") {
    return fail("not_in_this_release",
                "'" + text + "': this release keeps jobs in memory only; the one accepted value is :memory:");
  }
  config.data_dir = text;
  return {};
}

const Setting* find_setting(std::string_view name) {
  for (const Setting& setting : settings()) {
    if (setting.name == name) return &setting;
  }
  return nullptr;
}

Result<void> apply(Config& config, const Setting& setting, const std::string& value, const std::string& source) {
  if (auto set = setting.set(config, value); !set) return fail(set.error().code, source + ": " + set.error().detail);
  return {};
}

// What a file must say a setting with. Its name for the value tells.
ConfigMember::Type type_of(const Setting& setting) {
  if (setting.value_name.empty()) return ConfigMember::Type::truth;
  for (const std::string_view whole : {"N", "MB", "S", "MS"})
    if (setting.value_name == whole) return ConfigMember::Type::whole;
  return ConfigMember::Type::text;
}

std::string type_name(ConfigMember::Type type) {
  return type == ConfigMember::Type::truth   ? "true or false"
         : type == ConfigMember::Type::whole ? "a whole number"
                                             : "a string";
}

Result<void> apply_file(Config& config, const std::string& path) {
  const auto members = read_config_file(path);
  if (!members) return ::tl::unexpected(members.error());
  std::map<const Setting*, const ConfigMember*> seen;  // max_queue and max-queue are one setting
  for (const ConfigMember& member : *members) {
    const std::string where =
        path + ":" + std::to_string(member.line) + ":" + std::to_string(member.column) + ": '" + member.key + "'";
    const Setting* setting = find_setting(with(member.key, '_', '-'));
    if (!setting) return fail("unknown_name", where + " is no setting (tilelightd --help names all)");
    const auto [first, is_new] = seen.emplace(setting, &member);
    if (!is_new)
      return fail("duplicate_name",
                  where + " comes twice; line " + std::to_string(first->second->line) + " has it before");
    if (member.type != type_of(*setting))
      return fail("wrong_type", where + " is " + type_name(member.type) + ", " + member.value +
                                    "; allowed: " + type_name(type_of(*setting)));
    if (auto done = apply(config, *setting, member.value, where); !done) return done;
  }
  return {};
}

Result<void> apply_environment(Config& config, const std::map<std::string, std::string>& environment) {
  for (const auto& [name, value] : environment) {
    if (name.rfind("TILELIGHT_", 0) != 0 || name == "TILELIGHT_CONFIG") continue;
    const auto& all = settings();
    const auto setting =
        std::find_if(all.begin(), all.end(), [&name = name](const Setting& s) { return environment_name(s) == name; });
    if (setting == all.end()) return fail("unknown_name", "the environment sets " + name + ", which is no setting");
    if (auto done = apply(config, *setting, value, name); !done) return done;
  }
  return {};
}

// Looks a host up. Without a word of assent every address that it has must be this machine's alone.
Result<std::vector<std::string>> checked_addresses(const std::string& flag, const std::string& host, bool allow_open,
                                                   const Resolve& resolve) {
  auto addresses = resolve(host);
  if (!addresses) return fail(addresses.error().code, flag + ": " + addresses.error().detail);
  const auto open = std::find_if_not(addresses->begin(), addresses->end(), is_loopback);
  if (open == addresses->end() || allow_open) return addresses;
  return fail("public_bind", flag + " " + host + (*open == host ? "" : ", which is " + *open + ",") +
                                 " can be reached from other machines and there are no keys; say --allow-open if "
                                 "that is meant (a proxy or a firewall in front), or bind 127.0.0.1");
}

}  // namespace

const std::vector<Setting>& settings() {
  static const std::vector<Setting> table = {
      {"host", "ADDRESS", "address to listen on [127.0.0.1]", text_field(&Config::host)},
      {"port", "N", "port to listen on; 0 picks a free one [8080]", number(&Config::port, 0, 65535)},
      {"admin-host", "ADDRESS", "address of health checks and metrics [127.0.0.1]", text_field(&Config::admin_host)},
      {"admin-port", "N", "port of health checks and metrics; 0 picks a free one [8081]",
       number(&Config::admin_port, 0, 65535)},
      {"data-dir", ":memory:", "where jobs are kept; this release: in memory only [:memory:]", set_data_dir},
      {"allow-open", "", "allow a public address although there are no keys", set_allow_open},
      {"allowed-hosts", "NAMES", "names accepted in the Host header beside localhost and addresses, with commas",
       set_allowed_hosts},
      {"trusted-proxy", "ADDRESSES",
       "addresses and networks (10.0.0.0/8) of proxies whose X-Forwarded-For, -Proto, -Host and -Prefix count, with "
       "commas; they must set or delete all four [none]",
       set_trusted_proxies},
      {"threads", "N", "render threads; 0: one a hardware thread [0]", number(&Config::threads, 0, 1024)},
      {"max-queue", "N", "renders that may wait for their start; more are answered 503 [256]",
       number(&Config::max_queue, 0, 1'000'000)},
      {"max-wait-s", "S",
       "longest that a request waits for a render, a change or a frame without a byte; keep it below the time-outs of "
       "proxies [40]",
       number(&Config::max_wait_s, 1, 3600)},
      {"max-sessions", "N", "interactive sessions at once [64]", number(&Config::max_sessions, 0, 100'000)},
      {"scene-cache-mb", "MB", "compiled scenes kept for reuse [1024]", number(&Config::scene_cache_mb, 0, 1 << 20)},
      {"results-mb", "MB", "finished images kept [512]", number(&Config::results_mb, 1, 1 << 20)},
      {"max-results", "N", "finished renders kept [1000]", number(&Config::max_results, 1, kMaxJobRecords)},
      {"pictures-mb", "MB", "pictures of stored scenes kept, so that asking again renders nothing [64]",
       number(&Config::pictures_mb, 0, 1 << 20)},
      {"films-mb", "MB", "films of finished renders kept, so that these can be refined; 0: none [1024]",
       number(&Config::films_mb, 0, 1 << 20)},
      {"film-keep-s", "S", "how long a film is kept at most [300]", number(&Config::film_keep_s, 0, 86'400)},
      {"max-body-bytes", "N", "largest scene document [16777216]", limit(&Limits::bytes, 1024, int64_t{1} << 30)},
      {"max-pixels", "N", "largest image [16777216]", limit(&Limits::pixels, 1, int64_t{1} << 32)},
      {"max-samples", "N", "most samples a pixel [4096]", limit(&Limits::samples, 1, 1 << 24)},
      {"quiet", "", "log warnings and errors only", set_quiet},
      {"log-level", "LEVEL", "debug, info, warn, error or off [info]", set_log_level},
      {"log-format", "FORMAT", "text, json, or auto: text on a terminal, JSON lines otherwise [auto]", set_log_format},
  };
  return table;
}

std::map<std::string, std::string> process_environment() {
  std::map<std::string, std::string> out;
  for (char** entry = environ; entry && *entry; ++entry) {
    const std::string_view text = *entry;
    const size_t equals = text.find('=');
    if (equals != std::string_view::npos) out.emplace(text.substr(0, equals), text.substr(equals + 1));
  }
  return out;
}

Result<ConfigRequest> load_config(int argc, const char* const* argv,
                                  const std::map<std::string, std::string>& environment, const Resolve& resolve) {
  CLI::App app("Tilelight render server: POST a scene, get an image.", "tilelightd");
  app.set_version_flag("--version", "tilelightd " TILELIGHT_VERSION);
  std::optional<std::string> file;
  if (const auto named = environment.find("TILELIGHT_CONFIG"); named != environment.end() && !named->second.empty())
    file = named->second;
  app.add_option("--config", file, "JSON file with these settings, e.g. {\"max_queue\": 64}")->type_name("FILE");
  std::vector<std::pair<const Setting*, std::string>> flags;
  for (const Setting& setting : settings()) {
    const std::string flag = "--" + std::string(setting.name);
    if (setting.value_name.empty()) {
      app.add_flag_callback(
          flag, [&] { flags.emplace_back(&setting, "true"); }, std::string(setting.help));
    } else {
      app.add_option_function<std::string>(
             flag, [&](const std::string& value) { flags.emplace_back(&setting, value); }, std::string(setting.help))
          ->type_name(std::string(setting.value_name));
    }
  }
  ConfigRequest request;
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    std::ostringstream out;
    app.exit(asked, out, out);
    request.help_or_version = true;
    request.text = out.str();
    return request;
  } catch (const CLI::ParseError& error) {
    return fail("bad_flag", std::string(error.what()) + " (tilelightd --help names all settings)");
  }
  Config& config = request.config;
  if (file) {
    if (auto done = apply_file(config, *file); !done) return ::tl::unexpected(done.error());
  }
  if (auto done = apply_environment(config, environment); !done) return ::tl::unexpected(done.error());
  for (const auto& [setting, value] : flags) {
    if (auto done = apply(config, *setting, value, "--" + std::string(setting->name)); !done) {
      return ::tl::unexpected(done.error());
    }
  }
  auto addresses = checked_addresses("--host", config.host, config.allow_open, resolve);
  if (!addresses) return ::tl::unexpected(addresses.error());
  config.host_addresses = std::move(*addresses);
  addresses = checked_addresses("--admin-host", config.admin_host, config.allow_open, resolve);
  if (!addresses) return ::tl::unexpected(addresses.error());
  config.admin_addresses = std::move(*addresses);
  return request;
}

}  // namespace tilelight::server
