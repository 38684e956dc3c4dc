// SPDX-License-Identifier: Apache-2.0
#include "server/metrics.h"

#include <cstdio>

namespace tilelight::server {
namespace {

// One table of the counters' meanings; a counter without a line here prints without HELP.
constexpr std::pair<std::string_view, std::string_view> kHelp[] = {
    {"tilelight_http_requests_total", "Requests answered, by route and status."},
    {"tilelight_http_refused_total", "Connections or requests refused before routing, by status."},
    {"tilelight_renders_total", "Renders ended, by state."},
    {"tilelight_renders_shared_total", "Requests that joined an identical render in flight."},
    {"tilelight_rays_total", "Rays traced by ended renders, by kind."},
    {"tilelight_scene_cache_total", "Look-ups of compiled scenes, by result."},
    {"tilelight_session_frames_total", "Frames delivered to sessions."},
};

std::string number_text(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  double back = 0.0;
  char brief[40];
  std::snprintf(brief, sizeof brief, "%.12g", value);
  std::sscanf(brief, "%lf", &back);
  return back == value ? brief : text;
}

void header(std::string& out, std::string_view name, std::string_view help, std::string_view type) {
  if (!help.empty()) out.append("# HELP ").append(name).append(" ").append(help).append("\n");
  out.append("# TYPE ").append(name).append(" ").append(type).append("\n");
}

}  // namespace

void Metrics::add(std::string_view name, std::string_view labels, double amount) {
  const std::lock_guard lock(mutex_);
  auto counter = counters_.find(name);
  if (counter == counters_.end()) counter = counters_.try_emplace(std::string(name)).first;
  auto cell = counter->second.find(labels);
  if (cell == counter->second.end()) cell = counter->second.try_emplace(std::string(labels)).first;
  cell->second += amount;
}

double Metrics::value(std::string_view name, std::string_view labels) const {
  const std::lock_guard lock(mutex_);
  const auto counter = counters_.find(name);
  if (counter == counters_.end()) return 0.0;
  const auto cell = counter->second.find(labels);
  return cell == counter->second.end() ? 0.0 : cell->second;
}

void Metrics::observe_request_ms(double ms) {
  size_t bucket = 0;
  while (bucket < kBucketsMs.size() && ms > kBucketsMs[bucket]) ++bucket;
  const std::lock_guard lock(mutex_);
  ++requests_[bucket];
  request_sum_ms_ += ms;
}

void Metrics::gauge(std::string_view name, std::string_view help, std::function<double()> read) {
  const std::lock_guard lock(mutex_);
  gauges_.push_back({std::string(name), std::string(help), std::move(read)});
}

std::string Metrics::prometheus_text() const {
  std::string out;
  std::vector<Gauge> gauges;
  {
    const std::lock_guard lock(mutex_);
    gauges = gauges_;
    for (const auto& [name, cells] : counters_) {
      std::string_view help;
      for (const auto& [known, text] : kHelp) help = known == name ? text : help;
      header(out, name, help, "counter");
      for (const auto& [labels, value] : cells) {
        out += labels.empty() ? name : name + "{" + labels + "}";
        out += " " + number_text(value) + "\n";
      }
    }
    const std::string name = "tilelight_http_request_duration_seconds";
    header(out, name, "Time from the complete request to the complete response.", "histogram");
    uint64_t sum = 0;
    for (size_t i = 0; i < kBucketsMs.size(); ++i) {
      sum += requests_[i];
      out += name + "_bucket{le=\"" + number_text(kBucketsMs[i] / 1000.0) + "\"} " + std::to_string(sum) + "\n";
    }
    sum += requests_.back();
    out += name + "_bucket{le=\"+Inf\"} " + std::to_string(sum) + "\n";
    out += name + "_sum " + number_text(request_sum_ms_ / 1000.0) + "\n";
    out += name + "_count " + std::to_string(sum) + "\n";
  }
  for (const Gauge& gauge : gauges) {
    header(out, gauge.name, gauge.help, gauge.name.ends_with("_total") ? "counter" : "gauge");
    out += gauge.name + " " + number_text(gauge.read()) + "\n";
  }
  return out;
}

}  // namespace tilelight::server
