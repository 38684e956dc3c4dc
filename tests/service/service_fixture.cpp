// SPDX-License-Identifier: Apache-2.0
#include "tests/service/service_fixture.h"

#include <stdexcept>

namespace tilelight::service {
namespace {

std::string scene(int width, int height, int samples, int seed) {
  return R"({"image": {"width": )" + std::to_string(width) + R"(, "height": )" + std::to_string(height) +
         R"(}, "render": {"samples": )" + std::to_string(samples) + R"(, "seed": )" + std::to_string(seed) +
         R"(}, "objects": [{"type": "sphere", "center": [0,1,0], "material": {"reflection": 0.3}},
                           {"type": "box", "min": [-3,-1,-3], "max": [3,0,3]}]})";
}

}  // namespace

std::unique_ptr<Service> ServiceTest::service_;

Service::Service(server::Config config) {
  config.port = config.admin_port = 0;
  config.log_level = "off";
  config.drain_ms = 0.0;
  auto app = server::App::open(std::move(config), clock_);
  if (!app) throw std::runtime_error(app.error().detail);
  app_ = std::move(*app);
  app_->start();
}

Json Service::wait_for_end(const std::string& location) const {
  for (;;) {
    const HttpAnswer answer = get(location, {{"Prefer", "wait=60"}});
    const Json status = Json::parse(answer.body, nullptr, false);
    if (answer.status != 200 || (status.at("state") != "queued" && status.at("state") != "running")) return status;
  }
}

double Service::metric(const std::string& sample) const {
  const std::string text = "\n" + ask(admin_port(), "GET", "/metrics").body;
  const size_t at = text.find("\n" + sample + " ");
  return at == std::string::npos ? 0.0 : std::atof(text.c_str() + at + sample.size() + 2);
}

bool Service::metric_reaches(const std::string& sample, double value) const {
  const auto until = server::after_ms(30'000.0);
  while (server::Steady::now() < until) {
    if (metric(sample) >= value) return true;
  }
  return false;
}

std::string small_scene(int seed) { return scene(48, 32, 2, seed); }
std::string endless_scene(int seed) { return scene(2048, 2048, 4096, seed); }

std::string line_scene(const std::string& render) {
  return R"({"image": {"width": 48, "height": 32}, "camera": {"position": [5, 4, 6]},
             "render": {"algorithm": "roberts")" +
         render + R"(}, "objects": [{"type": "box", "min": [-1, -1, -1], "max": [1, 1, 1]}]})";
}

std::pair<int, int> png_size(std::string_view bytes) {
  if (bytes.size() < 24 || bytes.substr(1, 3) != "PNG") return {0, 0};
  const auto number = [&](size_t at) {
    int value = 0;
    for (size_t i = at; i < at + 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
    return value;
  };
  return {number(16), number(20)};
}

}  // namespace tilelight::service
