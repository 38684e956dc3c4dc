// SPDX-License-Identifier: Apache-2.0
#include "renderer/measure/reference_media.h"

#include <utility>

namespace tilelight::reference {
namespace {

// All of one body's surfaces in the place: the ray may enter it, leave it, or both.
struct Visit {
  uint32_t body;
  std::optional<Hit> entry, exit;
  int entries = 0, exits = 0;  // through the middle of triangles

  // Times that it enters more often than it leaves. What it meets on edges alone is met once.
  int net() const { return (entries > 0 ? entries : entry.has_value()) - (exits > 0 ? exits : exit.has_value()); }
};

std::vector<Visit> visits_of(const ReferenceScene& scene, const std::vector<Hit>& surfaces, const Vec3& direction) {
  std::vector<Visit> visits;
  for (const Hit& hit : surfaces) {
    const auto same = std::find_if(visits.begin(), visits.end(), [&](const Visit& v) { return v.body == hit.body; });
    Visit& visit = same != visits.end() ? *same : visits.emplace_back(Visit{hit.body, {}, {}});
    const ReferenceBody& body = scene.body(hit.body);
    const bool goes_in = glm::dot(geometric_normal(body, hit), direction) < 0.0;
    std::optional<Hit>& side = goes_in ? visit.entry : visit.exit;
    if (!side || hit.primitive < side->primitive) side = hit;
    const Vec3& weight = hit.barycentric;
    if (body.kind == BodyKind::mesh && std::min({weight.x, weight.y, weight.z}) > 1e-9)
      ++(goes_in ? visit.entries : visit.exits);
  }
  return visits;
}

using Entry = std::pair<double, const Visit*>;  // how long the way through the body is

// Of media entered together, the one left last is the outermost; of those left in one place, the one of lowest rank.
void sort_outermost_first(const ReferenceScene& scene, std::vector<Entry>& entered) {
  std::sort(entered.begin(), entered.end(), [](const Entry& a, const Entry& b) { return a.first > b.first; });
  for (auto first = entered.begin(); first != entered.end();) {
    const double nearest = first->first * (1.0 - 0x1p-40);
    const auto last = std::find_if(first, entered.end(), [&](const Entry& e) { return e.first < nearest; });
    std::sort(first, last, [&](const Entry& a, const Entry& b) {
      return scene.body(a.second->body).rank < scene.body(b.second->body).rank;
    });
    first = last;
  }
}

}  // namespace

Interface make_interface(const ReferenceScene& scene, const MediaStack& media, const std::vector<Hit>& surfaces,
                         const Vec3& direction) {
  Interface out{media, {}, {}};
  std::vector<Visit> visits = visits_of(scene, surfaces, direction);
  // From one part of a body into the next: nothing happens.
  std::erase_if(visits, [&](const Visit& v) { return v.net() == 0 && media.contains(v.body); });
  std::vector<Entry> entered;
  for (const Visit& v : visits) {
    if (v.net() < 0 && !out.here.contains(v.body)) out.here = out.here.with(v.body);
    if (v.net() > 0) entered.emplace_back(scene.way_through(*v.entry, direction), &v);
  }
  sort_outermost_first(scene, entered);
  out.beyond = out.here;
  for (const Visit& v : visits)
    for (int i = v.net(); i < 0; ++i) out.beyond = out.beyond.without(v.body);
  for (const auto& [way, visit] : entered)
    for (int i = 0; i < visit->net(); ++i) out.beyond = out.beyond.with(visit->body);

  const auto is_bound = [&](const Visit& v) {
    return (v.net() > 0 && out.beyond.top(scene) == v.body) || (v.net() < 0 && out.here.top(scene) == v.body);
  };
  // A body that is thinner than numbers can tell is a thin one.
  const auto is_thin = [&](const Visit& v) { return v.net() == 0 && out.here.with(v.body).top(scene) == v.body; };
  auto shown = std::find_if(visits.begin(), visits.end(), is_bound);
  if (shown == visits.end()) shown = std::find_if(visits.begin(), visits.end(), is_thin);
  if (shown != visits.end()) out.shown = shown->net() >= 0 ? shown->entry : shown->exit;
  return out;
}

}  // namespace tilelight::reference
