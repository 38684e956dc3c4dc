// SPDX-License-Identifier: Apache-2.0
#include "server/http/documents.h"

#include <nlohmann/json.hpp>

#include "renderer/base/characters.h"
#include "server/clock.h"

namespace tilelight::server {
namespace {

using Json = nlohmann::ordered_json;

// Names of a scene's author come with it: a terminal that shows the answer acts on none of their characters.
std::string text_of(const Json& json) {
  return printable_json(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

Json time_or_null(int64_t wall_ms) { return wall_ms > 0 ? Json(rfc3339(wall_ms)) : Json(nullptr); }

Json vector_json(const Vec3& v) { return {v.x, v.y, v.z}; }

Json warnings_of(const std::vector<SceneWarning>& read, const Plan& plan = {}) {
  return Json::parse(warnings_json(read, plan.warnings));
}

// Of reading the scene, and, of a job whose picture is an EXR, of what that cannot hold.
std::vector<SceneWarning> warnings_beside_plan(const JobRecord& record) {
  std::vector<SceneWarning> warnings = record.warnings;
  const int64_t clamped = record.format == ImageFormat::exr ? record.status.clamped.value_or(0) : 0;
  if (clamped > 0) warnings.push_back({"/image/exposure", "clamped", clamped_warning(clamped, ImageFormat::exr)});
  return warnings;
}

// As the scene language spells it, so that it can be sent back.
Json camera_json(const Camera& camera) {
  const bool is_perspective = camera.projection == Projection::perspective;
  Json out = {{"type", is_perspective ? "perspective" : "orthographic"},
              {"position", vector_json(camera.position)},
              {"target", vector_json(camera.target)},
              {"up", vector_json(camera.up)}};
  out[is_perspective ? "fov_y_deg" : "height"] = is_perspective ? camera.fov_y_deg : camera.height;
  return out;
}

Json progress_json(const RenderProgress& progress) {
  return {{"fraction", progress.fraction},
          {"spp", progress.spp},
          {"elapsed_ms", progress.elapsed_ms},
          {"eta_ms", progress.eta_ms >= 0.0 ? Json(progress.eta_ms) : Json(nullptr)}};
}

Json timings_json(const Timings& t) {
  return {{"parse_ms", t.parse_ms}, {"queue_ms", t.queue_ms},   {"compile_ms", t.compile_ms},
          {"plan_ms", t.plan_ms},   {"render_ms", t.render_ms}, {"encode_ms", t.encode_ms}};
}

Json brief_json(const JobRecord& record, std::string_view prefix) {
  const WorkStatus& status = record.status;
  Json out = {{"id", record.id},
              {"state", job_state_name(status.state)},
              {"revision", status.revision},
              {"scene", record.scene_id},
              {"refines", record.refines.empty() ? Json(nullptr) : Json(record.refines)},
              {"priority", priority_name(record.priority)},
              {"format", image_format_name(record.format)},
              {"created_at", time_or_null(status.created_ms)},
              {"started_at", time_or_null(status.started_ms)},
              {"finished_at", time_or_null(status.finished_ms)},
              {"progress", progress_json(status.progress)}};
  const bool has_image = status.state == JobState::done && !record.result_expired;
  out["image_url"] = has_image ? Json(std::string(prefix) + "/v1/renders/" + record.id + "/image") : Json(nullptr);
  if (!status.error.empty()) out["error"] = {{"detail", status.error}};
  return out;
}

}  // namespace

std::string report_document(const JobRecord& record, const std::string& image_hash,
                            const std::optional<double>& rounding) {
  const ReportIdentity identity{TILELIGHT_VERSION, record.scene_id,       image_hash,
                                rounding,          record.status.clamped, warnings_beside_plan(record)};
  return report_json(record.status.report, record.status.plan.value_or(Plan{}), identity);
}

std::string job_json(const JobRecord& record, std::string_view prefix) {
  const WorkStatus& status = record.status;
  Json out = brief_json(record, prefix);
  out["timings"] = timings_json(status.timings);
  auto warnings = warnings_beside_plan(record);
  for (SceneWarning& warning : report_warnings(status.report)) warnings.push_back(std::move(warning));
  out["warnings"] = warnings_of(warnings, status.plan.value_or(Plan{}));
  out["plan"] = status.plan ? Json::parse(plan_json(*status.plan)) : Json(nullptr);
  const bool has_report = status.plan && !status.report.points.empty();
  out["report"] = has_report ? Json::parse(report_document(record, "")) : Json(nullptr);
  return text_of(out);
}

std::string jobs_json(const std::vector<JobRecord>& records, std::string_view prefix) {
  Json list = Json::array();
  for (const JobRecord& record : records) list.push_back(brief_json(record, prefix));
  return text_of({{"renders", std::move(list)}});
}

std::string state_document(const WorkStatus& status) {
  Json out = {{"state", job_state_name(status.state)}, {"revision", status.revision}};
  if (!status.report.stop.empty()) out["stop"] = status.report.stop;
  if (!status.error.empty()) out["error"] = {{"detail", status.error}};
  return text_of(out);
}

std::string progress_document(const RenderProgress& progress) { return text_of(progress_json(progress)); }

std::string point_document(const ReportPoint& point) {
  RenderReport report;
  report.points = {point};
  return text_of(Json::parse(report_json(report, Plan{})).at("points").at(0));
}

std::string report_csv(const RenderReport& report) {
  std::string out =
      "pass,spp,elapsed_ms,cpu_ms,rays_primary,rays_shadow,rays_reflected,rays_refracted,rmse,rmse_low,rmse_high,"
      "est_p99,est_max,unconverged,truncation_bound,nonfinite,lights_on_hits\n";
  for (const ReportPoint& point : report.points) {
    const ErrorSummary& error = point.error;
    const auto known = [&error](double value) { return error.is_known ? Json(value) : Json(""); };
    // JSON's numbers are also CSV's: the shortest text that reads back to the same value. What is not known is empty.
    const Json row = {point.pass,
                      point.spp,
                      point.elapsed_ms,
                      point.cpu_ms,
                      point.rays.primary,
                      point.rays.shadow,
                      point.rays.reflected,
                      point.rays.refracted,
                      known(error.rmse),
                      known(error.low),
                      known(error.high),
                      known(error.p99),
                      known(error.most),
                      known(static_cast<double>(error.unconverged)),
                      point.truncation_bound < 0.0 ? Json("") : Json(point.truncation_bound),
                      point.nonfinite,
                      point.lights_on_hits};
    std::string text = row.dump();
    std::erase(text, '"');
    out += text.substr(1, text.size() - 2) + "\n";
  }
  return out;
}

std::string scene_document(std::string_view id, const std::vector<SceneWarning>& warnings) {
  return text_of({{"id", id}, {"warnings", warnings_of(warnings)}});
}

std::string plan_document(std::string_view scene_id, const std::vector<SceneWarning>& warnings, const ViewPlan& plan,
                          const CostPrediction& cost) {
  return text_of({{"scene", scene_id},
                  {"warnings", warnings_of(warnings, plan.plan)},
                  {"predicted", Json::parse(cost_json(cost))},
                  {"plan", Json::parse(plan_json(plan.plan))},
                  {"camera", camera_json(plan.camera)}});
}

std::string session_document(std::string_view id, std::string_view scene_id, const std::vector<SceneWarning>& warnings,
                             const ViewPlan& plan) {
  const ImageSpec& image = plan.view.image;
  return text_of({{"id", id},
                  {"scene", scene_id},
                  {"camera", camera_json(plan.camera)},
                  {"image", {{"width", image.width}, {"height", image.height}, {"exposure", image.exposure}}},
                  {"view_seq", 0},
                  {"bounds", {{"min", vector_json(plan.plan.bounds_min)}, {"max", vector_json(plan.plan.bounds_max)}}},
                  {"plan", Json::parse(plan_json(plan.plan))},
                  {"warnings", warnings_of(warnings, plan.plan)}});
}

std::string limits_document(const Config& config) {
  Json out = Json::parse(limits_json(config.limits));
  for (const ImageFormat format : image_formats(true))
    out["formats"][std::string(image_format_name(format))] = {
        {"image_side", std::min(config.limits.image_side, max_image_side(format))}};
  out["server"] = {{"max_queue", config.max_queue},     {"max_sessions", config.max_sessions},
                   {"max_results", config.max_results}, {"films_mb", config.films_mb},
                   {"film_keep_s", config.film_keep_s}, {"max_wait_s", config.max_wait_s},
                   {"max_streams", config.max_streams}};
  return text_of(out);
}

std::string version_document(int threads) {
  return text_of({{"name", "tilelightd"}, {"version", TILELIGHT_VERSION}, {"api", 1}, {"threads", threads}});
}

}  // namespace tilelight::server
