// SPDX-License-Identifier: Apache-2.0
// The documents that the API answers with. Pure.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/config.h"
#include "server/jobs/job.h"

namespace tilelight::server {

// prefix: of our paths as the client sees them.
std::string job_json(const JobRecord& record, std::string_view prefix);
// image_hash: empty where it is not known.
std::string report_document(const JobRecord& record, const std::string& image_hash,
                            const std::optional<double>& rounding = {});
// {"renders": [...]}, without plans and reports.
std::string jobs_json(const std::vector<JobRecord>& records, std::string_view prefix);
// The data of events, each on one line.
std::string state_document(const WorkStatus& status);
std::string progress_document(const RenderProgress& progress);
std::string point_document(const ReportPoint& point);
std::string report_csv(const RenderReport& report);

std::string scene_document(std::string_view id, const std::vector<SceneWarning>& warnings);
std::string plan_document(std::string_view scene_id, const std::vector<SceneWarning>& warnings, const ViewPlan& plan,
                          const CostPrediction& cost);
std::string session_document(std::string_view id, std::string_view scene_id, const std::vector<SceneWarning>& warnings,
                             const ViewPlan& plan);
std::string limits_document(const Config& config);
std::string version_document(int threads);

// What the server says of itself at length. Made once, since it takes milliseconds.
struct Descriptions {
  std::string scene_schema;
  // The description of the API with the scene language in it, so that it needs no other document. Between its halves
  // stands the server's address as the client sees it.
  std::string openapi_before_url, openapi_after_url;
  std::string openapi_hash;  // of both
};
Descriptions make_descriptions(const Config& config);

}  // namespace tilelight::server
