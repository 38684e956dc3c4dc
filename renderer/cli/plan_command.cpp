// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iomanip>
#include <sstream>

#include "renderer/cli/commands.h"
#include "renderer/cli/complain.h"
#include "renderer/renderer.h"
#include "renderer/trace/isa.h"

namespace tilelight::cli {
namespace {

std::string vector_text(const Vec3& v) {
  std::ostringstream out;
  out << std::setprecision(4) << "(" << v.x << ", " << v.y << ", " << v.z << ")";
  return out.str();
}

std::string bytes_text(int64_t bytes) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(1);
  if (bytes < 1 << 20) {
    out << static_cast<double>(bytes) / 1024.0 << " KiB";
  } else {
    out << static_cast<double>(bytes) / (1024.0 * 1024.0) << " MiB";
  }
  return out.str();
}

// Two digits and no exponent: more would claim to know.
std::string rounded(double value) {
  double unit = 1e-6;
  while (value >= 99.5 * unit) unit *= 10.0;
  std::ostringstream out;
  out << std::setprecision(9) << std::defaultfloat << std::round(value / unit) * unit;
  return out.str();
}

std::string features_text(const FeatureSet& features) {
  std::string text;
  for (int i = 0; i < kFeatureCount; ++i) {
    const auto feature = static_cast<Feature>(i);
    if (features.has(feature)) text += (text.empty() ? "" : ", ") + std::string(feature_name(feature));
  }
  return text.empty() ? "none" : text;
}

std::string stop_text(const RenderSpec& render) {
  std::ostringstream out;
  if (!render.passes.empty()) return "a replay of " + std::to_string(render.passes.size()) + " passes";
  if (render.samples) out << *render.samples << " samples a pixel";
  if (render.rmse) out << (render.samples ? " or " : "") << "an rmse of " << *render.rmse;
  if (render.time_ms) out << (render.samples || render.rmse ? " or " : "") << *render.time_ms << " ms";
  return out.str();
}

void print_scene(std::ostream& out, const Plan& plan) {
  out << "scene     " << plan.bodies << " bodies, " << plan.lights << " lights, " << plan.triangles_stored
      << " triangles stored, " << plan.triangles_instanced << " with instances\n"
      << "bounds    " << vector_text(plan.bounds_min) << " to " << vector_text(plan.bounds_max) << "\n"
      << "memory    " << bytes_text(plan.memory_bytes) << "\n"
      << "compiled  in " << std::fixed << std::setprecision(1) << plan.compile_ms << " ms\n\n"
      << std::defaultfloat;
}

void print_view(std::ostream& out, const ViewPlan& plan, bool is_framed, const CostPrediction& cost, int threads) {
  const Camera& camera = plan.camera;
  out << "image     " << plan.view.image.width << " x " << plan.view.image.height << ", " << stop_text(plan.view.render)
      << "\n"
      << "camera    " << (is_framed ? "framed by default: " : "") << "from " << vector_text(camera.position) << " to "
      << vector_text(camera.target) << "\n"
      << "kernel    " << plan.plan.kernel << " on " << plan.plan.isa << "\n"
      << "features  " << features_text(plan.features) << "\n";
  out << "predicted " << rounded(cost.mrays) << " million rays, " << rounded(cost.spp) << " samples a pixel\n"
      << "          " << rounded(cost.elapsed_ms / 1000.0) << " s (" << rounded(cost.elapsed_low_ms / 1000.0) << " to "
      << rounded(cost.elapsed_high_ms / 1000.0) << ") on " << threads << (threads == 1 ? " thread\n" : " threads\n");
  if (cost.rmse >= 0.0)
    out << "          rmse " << rounded(cost.rmse) << " (" << rounded(cost.rmse_low) << " to "
        << rounded(cost.rmse_high) << ")\n";
}

void print_left_out(std::ostream& out, const std::vector<LeftOut>& left_out) {
  if (left_out.empty()) return;
  size_t width = 0;
  for (const LeftOut& item : left_out) width = std::max(width, item.what.size());
  out << "\nleft out, and so costing nothing\n";
  for (const LeftOut& item : left_out)
    out << "  " << std::left << std::setw(static_cast<int>(width)) << item.what << "  " << item.why
        << (item.cost.empty() ? "" : " (would cost " + item.cost + ")") << "\n";
}

}  // namespace

ExitCode run_plan(const SceneText& source, const PlanArguments& arguments) {
  if (auto isa = select_isa(arguments.isa); !isa) return complain(kBadInput, isa.error().detail);
  const auto parsed = parse_with_options(source, arguments.view);
  if (const ExitCode* code = std::get_if<ExitCode>(&parsed)) return *code;
  const auto& document = std::get<ParsedScene>(parsed);

  TilePool pool;
  const auto compiled = compile_scene(document.scene, pool);
  const ViewPlan plan = plan_view(*compiled, document.view);
  print_warnings(source.name, plan.plan.warnings);
  std::ostringstream out;
  const CostPrediction cost = predict_cost(compiled, plan, pool);
  if (arguments.json) {
    out << R"({"predicted":)" << cost_json(cost) << R"(,"warnings":)"
        << warnings_json(document.warnings, plan.plan.warnings) << R"(,"plan":)" << plan_json(plan.plan) << "}\n";
    std::fputs(printable_json(out.str()).c_str(), stdout);
    return kOk;
  }
  print_scene(out, plan.plan);
  print_view(out, plan, !document.view.camera, cost, pool.thread_count());
  print_left_out(out, plan.plan.left_out);
  std::fputs(printable_lines(out.str()).c_str(), stdout);
  return kOk;
}

}  // namespace tilelight::cli
