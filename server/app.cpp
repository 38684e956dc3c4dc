// SPDX-License-Identifier: Apache-2.0
#include "server/app.h"

#include <condition_variable>

#include "server/process.h"

namespace tilelight::server {
namespace {

constexpr double kAnswerMs = 1'000.0;  // for the last answers to reach their clients
constexpr int kFreeWorkers = 32;       // that never wait for a render, so that other requests are always answered
constexpr int64_t kFilmBytes = int64_t{3} << 30;  // of running renders and of those that can be refined
constexpr int64_t kSceneStoreBytes = int64_t{256} << 20;

bool log_as_json(LogFormat format) {
  return format == LogFormat::json || (format == LogFormat::automatic && !Log::standard_error_is_terminal());
}

FrontOptions front_options(const Config& config) {
  FrontOptions options;
  options.port = config.port;
  options.workers = config.max_waiting + kFreeWorkers;
  options.limits.body_bytes = config.limits.bytes;
  options.head_timeout_ms = config.head_timeout_ms;
  return options;
}

JobQueue::Options queue_options(const Config& config) {
  JobQueue::Options options;
  options.max_queue = config.max_queue;
  // What is kept is not there for what runs; a render that is larger than the rest has its lane for itself.
  options.max_film_bytes = std::max(kFilmBytes / 4, kFilmBytes - (config.films_mb << 20));
  return options;
}

FrontOptions admin_options(const Config& config) {
  FrontOptions options;
  options.port = config.admin_port;
  options.workers = 2;
  options.max_connections = 64;
  options.limits.body_bytes = 0;
  options.head_timeout_ms = config.head_timeout_ms;
  return options;
}

// Listens on the first of the host's addresses that this machine has. Not on the next where that one is in use: clients
// that try the addresses in their order would reach whoever uses it. flag: which port to change.
Result<std::unique_ptr<HttpServer>> bind_first(const std::vector<std::string>& addresses, const std::string& host,
                                               FrontOptions options, const std::vector<Route>& routes,
                                               Services& services, const std::string& flag) {
  Error error;
  for (const std::string& address : addresses.empty() ? std::vector{host} : addresses) {
    options.host = address;
    auto server = HttpServer::bind(options, routes, services);
    if (server) return server;
    error = server.error();
    if (error.code != "no_address") break;
  }
  return fail("bind", error.detail + " (" + flag + ")");
}

std::string url_of(const std::string& host, const std::vector<std::string>& addresses, int port) {
  const bool is_any = is_any_address(addresses.empty() ? host : addresses.front());
  const std::string name = is_any ? "localhost" : host.find(':') == std::string::npos ? host : "[" + host + "]";
  return "http://" + name + ":" + std::to_string(port) + "/";
}

}  // namespace

Result<std::unique_ptr<App>> App::open(Config config, const Clock& clock) {
  std::unique_ptr<App> app(new App(std::move(config), clock));
  const Config& own = app->config_;
  auto http = bind_first(own.host_addresses, own.host, front_options(own), api_routes(), app->services_, "--port");
  if (!http) return ::tl::unexpected(http.error());
  auto admin = bind_first(own.admin_addresses, own.admin_host, admin_options(own), admin_routes(), app->services_,
                          "--admin-port");
  if (!admin) return ::tl::unexpected(admin.error());
  app->http_ = std::move(*http);
  app->admin_ = std::move(*admin);
  app->add_gauges();
  return app;
}

App::App(Config config, const Clock& clock)
    : config_(std::move(config)),
      log_(config_.log_level, log_as_json(config_.log_format)),
      pool_(config_.threads),
      scenes_(kSceneStoreBytes),
      compiled_(CompiledCache::make(pool_, metrics_, config_.scene_cache_mb << 20)),
      queue_(JobQueue::make(pool_, compiled_, metrics_, log_, clock, queue_options(config_))),
      jobs_(Jobs::make(
          std::make_unique<MemoryJobStore>(size_t{kMaxJobRecords}), clock,
          {config_.max_results, config_.results_mb << 20, {config_.films_mb << 20, config_.film_keep_s * 1000.0}})),
      pictures_(config_.pictures_mb << 20),
      sessions_(pool_, clock, config_.max_sessions),
      keys_(clock),
      waits_(config_.max_waiting),
      streams_(config_.max_streams),
      descriptions_(make_descriptions(config_)),
      services_{config_,   log_,      metrics_, pool_,  scenes_,  *compiled_,    *queue_, *jobs_,
                pictures_, sessions_, keys_,    waits_, streams_, descriptions_, clock,   is_stopping_} {}

void App::add_gauges() {
  metrics_.gauge("tilelight_renders_queued", "Renders that wait for their start.",
                 [this] { return queue_->counts().queued; });
  metrics_.gauge("tilelight_renders_running", "Renders that have started.",
                 [this] { return queue_->counts().running; });
  metrics_.gauge("tilelight_jobs", "Jobs on record.", [this] { return static_cast<double>(jobs_->count()); });
  metrics_.gauge("tilelight_films_bytes", "Memory of the films of done renders that can be refined.",
                 [this] { return static_cast<double>(jobs_->films().bytes()); });
  metrics_.gauge("tilelight_sessions", "Interactive sessions.", [this] { return sessions_.count(); });
  metrics_.gauge("tilelight_scenes_stored", "Scenes stored by clients.",
                 [this] { return static_cast<double>(scenes_.count()); });
  metrics_.gauge("tilelight_scene_cache_bytes", "Memory of compiled scenes.",
                 [this] { return static_cast<double>(compiled_->bytes()); });
  metrics_.gauge("tilelight_requests_waiting", "Requests that wait for a render, a change or a frame.",
                 [this] { return config_.max_waiting - waits_.free(); });
  metrics_.gauge("tilelight_event_streams", "Clients that are told the events of a render.",
                 [this] { return config_.max_streams - streams_.free(); });
  metrics_.gauge("tilelight_http_connections", "Open connections.",
                 [this] { return static_cast<double>(http_->connection_count()); });
  metrics_.gauge("tilelight_http_unread_bytes", "Memory of responses that clients have not read yet.",
                 [this] { return static_cast<double>(http_->unread_bytes()); });
  metrics_.gauge("tilelight_pool_threads", "Threads that render.", [this] { return pool_.thread_count(); });
  metrics_.gauge("tilelight_log_lines_dropped_total", "Log lines that nobody read, or that could not be written.",
                 [this] { return static_cast<double>(log_.dropped()); });
  metrics_.gauge("process_cpu_seconds_total", "Processor time of the whole process, user and system.", cpu_seconds);
  metrics_.gauge("process_resident_memory_bytes", "Memory of the process that lies in RAM.", resident_bytes);
}

void App::start() {
  http_->start();
  admin_->start();
  housekeeper_ = std::jthread([this](std::stop_token stop) { housekeep(stop); });
}

// Sessions and films are also looked through on every use; this ends them where nobody comes.
void App::housekeep(std::stop_token stop) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  while (!never.wait_for(lock, stop, std::chrono::seconds(10), [&] { return stop.stop_requested(); })) {
    sessions_.close_idle();
    jobs_->films().drop_old();
  }
}

void App::stop() {
  if (has_stopped_) return;
  has_stopped_ = true;
  is_stopping_.store(true, std::memory_order_release);
  sessions_.close_all();
  queue_->drain(config_.drain_ms);
  if (http_) http_->stop(kAnswerMs);
  if (admin_) admin_->stop(kAnswerMs);
  housekeeper_ = {};
}

std::string App::url() const { return url_of(config_.host, config_.host_addresses, port()); }
std::string App::admin_url() const { return url_of(config_.admin_host, config_.admin_addresses, admin_port()); }

}  // namespace tilelight::server
