// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "renderer/study/html.h"
#include "renderer/study/study.h"
#include "renderer/study/tables.h"

namespace tilelight {
namespace {

using namespace html;

std::string pictures(const Study& study) {
  const StudyRun& finest = study.series.front().runs.back();
  return "<div class=\"pictures\">\n" +
         figure("reference.png", "The reference: " + std::to_string(study.reference_samples) + " samples a pixel") +
         figure("picture.png", "By " + study.series.front().name + ": " + finest.setting) +
         figure("error.png",
                "Its true error by pixel: black to purple at 1/255, red at 6/255, pale yellow from 64/255 on") +
         figure("told.png", "The bound that it told itself: 95 % of errors are below, same colours") + "</div>\n";
}

std::string runs(const Study& study) {
  Table table({"series", "setting", "samples a pixel", "time, ms", "processor time, ms", "rmse", "told", "told right",
               "p99", "max", "relMSE", "PSNR, dB", "SSIM", "FLIP", "1 / (mse s)"});
  for (const StudySeries& series : study.series) {
    for (const StudyRun& run : series.runs) {
      const ImageError& e = run.error;
      const bool is_told = run.told_rmse >= 0.0;
      table.add({series.name, run.setting, text("%.3g", run.spp),
                 ms(run.time_ms) + " (" + ms(run.time_low_ms) + " - " + ms(run.time_high_ms) + ")",
                 run.cpu_ms > 0.0 ? ms(run.cpu_ms) : "", error(e.rmse), is_told ? error(run.told_rmse) : "",
                 is_told ? std::to_string(run.told_inside) + " of " + std::to_string(run.told_rounds) : "",
                 error(e.p99), error(e.most), text("%.2e", e.rel_mse), text("%.1f", e.psnr_db), text("%.4f", e.ssim),
                 text("%.4f", e.flip), text("%.3g", run.efficiency)},
                run.is_on_front ? "front" : "");
    }
  }
  return table.html();
}

std::string slopes(const Study& study) {
  Table table({"series", "rmse ~ samples^", "95 %", "rmse ~ time^", "95 %"});
  const auto interval = [](const std::optional<PowerLaw>& law) {
    return law ? text("%.2f", law->low) + " to " + text("%.2f", law->high) : "";
  };
  for (const StudySeries& series : study.series) {
    if (!series.by_samples && !series.by_time) continue;
    table.add({series.name, series.by_samples ? text("%.2f", series.by_samples->slope) : "",
               interval(series.by_samples), series.by_time ? text("%.2f", series.by_time->slope) : "",
               interval(series.by_time)});
  }
  return table.html();
}

// Beside each value, by how much it is better than the first series'.
std::string side_by_side(const Study& study, const std::vector<study::TableRow>& rows, bool by_time) {
  Cells head{by_time ? "time, ms" : "rmse"};
  for (const StudySeries& series : study.series) head.push_back(series.name);
  Table table(head);
  for (const study::TableRow& row : rows) {
    Cells cells{by_time ? ms(row.at) : error(row.at)};
    for (size_t i = 0; i < row.values.size(); ++i) {
      if (!row.values[i]) {
        cells.emplace_back("-");
        continue;
      }
      std::string cell = by_time ? error(*row.values[i]) : ms(*row.values[i]);
      if (i > 0 && row.values[0]) cell += text("  (%.2f)", *row.values[i] / *row.values[0]);
      cells.push_back(cell);
    }
    table.add(cells);
  }
  return table.html();
}

std::string knobs(const Study& study) {
  Table table({"knob", "value", "time, ms", "rmse to the exact one", "light missing, mean linear", "bound told"});
  for (const KnobRow& row : study.knobs) {
    table.add({row.knob,
               text("%g", row.value) + (row.is_exact      ? " (exact)"
                                        : row.is_of_scene ? " (scene)"
                                                          : ""),
               ms(row.time_ms), row.is_exact ? "-" : error(row.rmse), row.is_exact ? "-" : text("%.2e", row.truncation),
               row.knob == "detail"         ? ""
               : row.truncation_bound < 0.0 ? "none"
                                            : text("%.2e", row.truncation_bound)},
              row.is_of_scene ? "own" : "");
  }
  return table.html();
}

std::string components(const Study& study) {
  const StudyComponents& c = study.components;
  Table table({"part of the error", "how much", "by what it is known"});
  table.add({"sampling", error(c.sampling), "rmse of the finest run of the first series, to the reference"});
  table.add({"truncation", c.truncation_bound < 0.0 ? "no finite bound" : text("at most %.2e", c.truncation_bound),
             "bound of the mean linear light left untraced by depth, cut-off and budget"});
  table.add({"rounding", text("%.2e", c.rounding), "rmse to a twin in double, the same four samples a pixel"});
  table.add({"quantisation", text("%.2e", c.quantisation), "rmse of 8 bits; 1/(255 sqrt 12) = 1.13e-3 in theory"});
  return table.html();
}

std::string oracle(const Study& study) {
  int times = 0, errors = 0, known_errors = 0;
  Table table({"asked", "predicted ms", "95 %", "took ms", "predicted rmse", "95 %", "true rmse"});
  for (const OracleRow& row : study.oracle) {
    const CostPrediction& p = row.predicted;
    const bool is_known = row.is_rmse_inside.has_value();
    times += row.is_time_inside, known_errors += is_known, errors += row.is_rmse_inside.value_or(false);
    table.add({row.rule, ms(p.elapsed_ms), ms(p.elapsed_low_ms) + " to " + ms(p.elapsed_high_ms), ms(row.elapsed_ms),
               is_known ? error(p.rmse) : "", is_known ? error(p.rmse_low) + " to " + error(p.rmse_high) : "",
               error(row.rmse)},
              row.is_time_inside && row.is_rmse_inside.value_or(true) ? "" : "miss");
  }
  return "<p>Of " + std::to_string(study.oracle.size()) +
         " predictions of the time, the truth fell inside its interval in " + std::to_string(times) + "; of " +
         std::to_string(known_errors) + " of the error, in " + std::to_string(errors) + ".</p>\n" + table.html();
}

std::string peer_trials(const Study& study) {
  Table table({"setting", "samples a pixel", "processor time, ms", "time, ms", "rmse"});
  for (const PeerTrial& trial : study.peer_trials) {
    table.add({trial.setting, text("%.3g", trial.spp), ms(trial.cpu_ms), ms(trial.time_ms), error(trial.rmse)},
              trial.is_on_front ? "front" : "");
  }
  return table.html();
}

}  // namespace

std::string study_html(const Study& study) {
  std::string out = head(study.scene_name + ": error against run time");
  out += "<h1>Error against run time: " + escaped(study.scene_name) + "</h1>\n<p class=\"lead\">" +
         std::to_string(study.width) + " x " + std::to_string(study.height) + " pixels, " +
         std::to_string(study.rounds) + " rounds, " + std::to_string(study.threads) + " threads, kernel " +
         escaped(study.kernel) + " on " + escaped(study.isa) +
         ". Errors are of displayed values, white is 1, to a reference of " + std::to_string(study.reference_samples) +
         " samples a pixel whose own error is " + error(study.reference_rmse) +
         (study.least_rmse > 0.0
              ? text(", %.0f %%", 100.0 * study.reference_rmse / study.least_rmse) + " of the best run's"
              : "") +
         ".</p>\n";
  out += study_svg(study) + pictures(study);
  out +=
      "<h2>Runs</h2>\n<p>Median time, least and most in brackets. Green: no other run has less error in less time. "
      "Told: the rmse that the picture's own report says; told right: rounds whose true rmse is inside its 95 % "
      "interval.</p>\n" +
      runs(study);
  out += "<h2>How fast the error falls</h2>\n" + slopes(study);
  out += "<h2>At equal time: rmse</h2>\n<p>In brackets: over the first series'.</p>\n" +
         side_by_side(study, study::equal_time(study), true);
  out += "<h2>At equal error: ms</h2>\n" + side_by_side(study, study::equal_error(study), false);
  if (!study.knobs.empty())
    out +=
        "<h2>Knobs</h2>\n<p>Four samples a pixel, the same for every value, so that the difference is the knob's "
        "alone. Bold: as in the scene.</p>\n" +
        knobs(study);
  out += "<h2>Where the error comes from</h2>\n" + components(study);
  out += "<h2>Predictions</h2>\n" + oracle(study);
  if (!study.peer_trials.empty())
    out +=
        "<h2>How POV-Ray's settings were chosen</h2>\n<p>Every setting was tried once. Green: no other has less error "
        "in less processor time. For errors that fall by a factor of 1.4 the cheapest of the green ones was drawn "
        "again, as often as our own runs: these are the runs above. +AM1: a grid of rays in pixels that differ from "
        "their neighbours by the threshold +A; +AM2: pixels are divided where their corners differ; +R: how fine; "
        "+J: with jitter; +BM: the tree.</p>\n" +
        peer_trials(study);
  if (!study.notes.empty()) {
    out += "<h2>Notes</h2>\n<ul>\n";
    for (const std::string& note : study.notes) out += "<li>" + escaped(note) + "</li>\n";
    out += "</ul>\n";
  }
  return out + tail();
}

}  // namespace tilelight
