// SPDX-License-Identifier: Apache-2.0
// What the service's tests share: a server in this process on free ports, a clock moved by hand, and small scenes.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "server/app.h"
#include "tests/service/http_client.h"

namespace tilelight::service {

using Json = nlohmann::json;

class HandClock final : public server::Clock {
 public:
  double mono_ms() const override { return ms_; }
  int64_t wall_ms() const override { return 1'700'000'000'000 + static_cast<int64_t>(ms_); }
  void advance_ms(double ms) { ms_ = ms_ + ms; }

 private:
  std::atomic<double> ms_ = 0.0;
};

// A server with the given configuration, on ports of its own.
class Service {
 public:
  explicit Service(server::Config config = {});
  ~Service() { app_->stop(); }

  int port() const { return app_->port(); }
  int admin_port() const { return app_->admin_port(); }
  server::App& app() { return *app_; }
  HandClock& clock() { return clock_; }

  HttpAnswer get(std::string_view path, Fields fields = {}) const {
    return ask(port(), "GET", path, std::move(fields));
  }
  HttpAnswer post(std::string_view path, std::string_view json, Fields fields = {}) const {
    return ask_json(port(), "POST", path, json, std::move(fields));
  }
  // Long-polls the job until it is over; its last status.
  Json wait_for_end(const std::string& location) const;
  // A sample of the metrics, by name and labels as printed; 0 where there is none.
  double metric(const std::string& sample) const;
  // Asks the metrics until the sample (name and labels as printed) reaches the value. False if it never does.
  bool metric_reaches(const std::string& sample, double value) const;

 private:
  HandClock clock_;
  std::unique_ptr<server::App> app_;
};

// One server for all the tests of a suite.
class ServiceTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { service_ = std::make_unique<Service>(); }
  static void TearDownTestSuite() { service_.reset(); }
  static std::unique_ptr<Service> service_;
};

// A sphere on a plane, 48x32, 2 samples a pixel: milliseconds. The seed tells renders apart.
std::string small_scene(int seed = 0);
// The same at 2048x2048 and 4096 samples a pixel: longer than any test, unless it is cancelled.
std::string endless_scene(int seed = 0);

// A box seen from a corner, drawn by roberts, 48x32. render: more members of its "render", each with a comma before it.
std::string line_scene(const std::string& render = R"(, "samples": 2)");

// Width and height of a PNG; 0 where the bytes are none.
std::pair<int, int> png_size(std::string_view bytes);

}  // namespace tilelight::service
