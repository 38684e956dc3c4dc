// SPDX-License-Identifier: Apache-2.0
#include "renderer/base/simd_targets.h"

#include <hwy/highway.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cctype>

#include "renderer/trace/isa.h"

namespace tilelight {
namespace {

struct Isa {
  const char* name;
  int64_t target;
};
// Best first.
constexpr Isa kIsas[] = {{"AVX3", HWY_AVX3}, {"AVX2", HWY_AVX2}, {"SSE4", HWY_SSE4}, {"SCALAR", HWY_SCALAR}};

// What this CPU can run, whatever is selected now.
int64_t cpu_targets() {
  static const int64_t targets = hwy::SupportedTargets();
  return targets;
}

std::string upper(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return out;
}

}  // namespace

std::vector<std::string> available_isas() {
  std::vector<std::string> names;
  for (const Isa& isa : kIsas) {
    if (cpu_targets() & HWY_TARGETS & isa.target) names.emplace_back(isa.name);
  }
  return names;
}

std::string current_isa() {
  for (const Isa& isa : kIsas) {
    if (hwy::SupportedTargets() & HWY_TARGETS & isa.target) return isa.name;
  }
  return "unknown";
}

Result<void> select_isa(std::string_view name) {
  const std::string wanted = upper(name);
  const int64_t cpu = cpu_targets();
  if (wanted == "AUTO") {
    hwy::SetSupportedTargetsForTest(cpu);
    return {};
  }
  std::string allowed = "auto";
  for (const std::string& isa : available_isas()) allowed += ", " + isa;
  for (const Isa& isa : kIsas) {
    if (wanted != isa.name) continue;
    if (!(cpu & HWY_TARGETS & isa.target)) {
      return fail("not_available", "this CPU cannot run " + wanted + "; it can run: " + allowed);
    }
    hwy::SetSupportedTargetsForTest(isa.target);
    return {};
  }
  return fail("unknown_name", "no instruction set is called '" + std::string(name) + "'; allowed: " + allowed);
}

}  // namespace tilelight
