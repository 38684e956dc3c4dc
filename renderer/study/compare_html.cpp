// SPDX-License-Identifier: Apache-2.0
#include "renderer/study/compare.h"
#include "renderer/study/html.h"

namespace tilelight {
namespace {

using namespace html;

std::string name_of(const CompareRow& row) {
  return row.shading.empty() ? row.method : row.method + ", " + row.shading;
}

std::string count_text(double v) {
  return text(v == static_cast<double>(static_cast<int64_t>(v)) ? "%.0f" : "%.3g", v);
}

std::string table(const Comparison& c) {
  Table out({"method", "time, ms", "of the first", "rays, million", "of them for shadows", "memory, MiB",
             "rmse to the whole light", "FLIP", "pixels unlike rays, %", "rms unlike rays"});
  for (const CompareRow& row : c.rows) {
    const bool is_lines = row.shading.empty();
    out.add({name_of(row), ms(row.time_ms) + " (" + ms(row.time_low_ms) + " - " + ms(row.time_high_ms) + ")",
             text("%.2f", row.time_ms / c.rows.front().time_ms),
             is_lines ? "" : text("%.2f", 1e-6 * static_cast<double>(row.rays.total())),
             is_lines ? "" : text("%.2f", 1e-6 * static_cast<double>(row.rays.shadow)),
             row.memory_bytes > 0 ? text("%.1f", static_cast<double>(row.memory_bytes) / 0x1p20) : "",
             is_lines ? "" : error(row.error.rmse), is_lines ? "" : text("%.4f", row.error.flip),
             row.to_rays ? text("%.4f", 100.0 * row.to_rays->part) : "",
             row.to_rays ? text("%.2e", row.to_rays->rms) : ""});
  }
  return out.html();
}

// A row of pictures for each method, a column for each shading. ending: of the pictures' files.
template <class HasPicture>
std::string grid(const Comparison& c, const std::string& ending, const HasPicture& has_picture) {
  std::string out, method;
  for (const CompareRow& row : c.rows) {
    if (!has_picture(row)) continue;
    if (row.method != method) out += (method.empty() ? "" : "</div>\n") + std::string("<div class=\"pictures smooth\">\n");
    method = row.method;
    out += figure(file_stem(row) + ending, name_of(row));
  }
  return method.empty() ? out : out + "</div>\n";
}

std::string pictures(const Comparison& c) {
  const std::string caption =
      "The whole light model by rays, " + std::to_string(c.reference_samples) + " samples a pixel";
  return "<div class=\"pictures smooth\">\n" + figure("reference.png", caption) + "</div>\n" +
         grid(c, ".png", [](const CompareRow&) { return true; });
}

std::string differences(const Comparison& c) {
  return grid(c, "-off.png", [](const CompareRow& row) { return !row.off.empty(); });
}

std::string unlike_rays(const Comparison& c) {
  const std::string shown = grid(c, "-rays.png", [](const CompareRow& row) { return row.to_rays.has_value(); });
  if (shown.empty()) return shown;
  return "<h2>Beside rays that draw the same</h2>\n<p>Where a method shows something else than rays with its own "
         "light, its own shading, its own triangles and its own samples: only along edges, where the corners of "
         "triangles were rounded to 1/256 pixel.</p>\n" +
         shown;
}

std::string works(const Comparison& c) {
  std::string out;
  for (const CompareWork& w : c.works) {
    Table table({w.method, "for one sample of every pixel"});
    for (const MethodWork::Count& count : w.work.counts) table.add({count.name, count_text(count.value)});
    out += table.html();
    if (w.work.picture)
      out += "<div class=\"pictures smooth\">\n" + figure(w.method + "-work.png", w.work.caption) + "</div>\n";
  }
  return out;
}

}  // namespace

std::string comparison_html(const Comparison& c) {
  std::string out = head(c.scene_name + ": methods side by side");
  out += "<h1>Methods side by side: " + escaped(c.scene_name) + "</h1>\n<p class=\"lead\">" + std::to_string(c.width) +
         " x " + std::to_string(c.height) + " pixels, " + std::to_string(c.samples) + " samples a pixel, " +
         std::to_string(c.rounds) + " rounds, " + std::to_string(c.threads) + " threads on " + escaped(c.isa) +
         ".</p>\n";
  out += pictures(c);
  out +=
      "<h2>Cost and error</h2>\n<p>Median time, least and most in brackets. The whole light: mirrors, glass and all, "
      "lit by the point, spheres round. Unlike rays: beside a picture by rays of the same light, shading, triangles "
      "and samples, in 8 bits.</p>\n" +
      table(c);
  out +=
      "<h2>What each leaves out of the light</h2>\n<p>The error by pixel to the whole light model: black to purple "
      "at 1/255, red at 6/255, pale yellow from 64/255 on.</p>\n" +
      differences(c);
  out += unlike_rays(c);
  out += "<h2>Work</h2>\n" + works(c);
  if (!c.lines_svg.empty())
    out += "<h2>Lines</h2>\n<p>Also as <a href=\"roberts.svg\">roberts.svg</a>, to print at any size.</p>\n";
  return out + tail();
}

}  // namespace tilelight
