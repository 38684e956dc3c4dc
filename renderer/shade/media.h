// SPDX-License-Identifier: Apache-2.0
// MediaSets: the sets of transparent bodies that rays are inside of, in the order of entering. The medium that counts
// is the one of the highest priority, among equals the one entered last (after Schmidt and Budge 2002). However many
// media overlap, none is forgotten: a set is a history that shares its past with the sets it came from. A crossing adds
// one node or none; a history that has grown to twice its media, or of a few, is written anew. One thread at a time.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/compile/compiled_scene.h"
#include "renderer/shade/ray.h"

namespace tilelight {

class MediaSets {
 public:
  using Set = uint32_t;  // stays good until `shrink` takes it away
  static constexpr Set kOpenAir = kNone;

  explicit MediaSets(const CompiledScene& scene) : scene_(scene) {}

  Set with(Set set, uint32_t body) {
    const bool is_top = set == kOpenAir || priority(body) >= priority(nodes_[set].top);
    return push({body, set, is_top ? body : nodes_[set].top, false});
  }
  Set of(std::span<const uint32_t> outermost_first) {
    Set set = kOpenAir;
    for (const uint32_t body : outermost_first) set = with(set, body);
    return set;
  }
  // Takes the last entry of the body away. REQUIRES: contains(set, body).
  Set without(Set set, uint32_t body) {
    const Node head = nodes_[set];
    if (!head.is_left && head.body == body) return head.before;
    find_present(set);
    present_.erase(std::find(present_.begin(), present_.end(), body));
    if (present_.size() <= kFewMedia || history_ > 2 * present_.size()) {  // a new history, which keeps walks short
      std::reverse(present_.begin(), present_.end());
      return of(present_);
    }
    uint32_t top = present_[0];
    for (const uint32_t other : present_) {
      if (priority(other) > priority(top)) top = other;
    }
    return push({body, set, top, true});
  }
  bool contains(Set set, uint32_t body) const {
    int left = 0;
    for (Set at = set; at != kOpenAir; at = nodes_[at].before) {
      if (nodes_[at].body != body) continue;
      left += nodes_[at].is_left ? 1 : -1;
      if (left < 0) return true;
    }
    return false;
  }
  // The body whose medium counts; kNone: the open air.
  uint32_t top(Set set) const { return set == kOpenAir ? kNone : nodes_[set].top; }
  double ior(Set set) const {
    return set == kOpenAir ? 1.0 : scene_.materials[scene_.bodies[nodes_[set].top].material].source.ior;
  }

  uint32_t rank(uint32_t body) const { return scene_.bodies[body].rank; }

  // Sets made since size() was `size` are no more.
  size_t size() const { return nodes_.size(); }
  void shrink(size_t size) { nodes_.resize(size); }

 private:
  // A body is entered or left after what went before.
  struct Node {
    uint32_t body = kNone;
    Set before = kOpenAir;
    uint32_t top = kNone;  // of the set that this node is
    bool is_left = false;
  };
  static constexpr size_t kFewMedia = 4;

  int priority(uint32_t body) const { return scene_.materials[scene_.bodies[body].material].source.priority; }
  Set push(const Node& node) {
    nodes_.push_back(node);
    return static_cast<Set>(nodes_.size() - 1);
  }
  // Fills present_, the last entered first, and history_, in time linear in the latter.
  void find_present(Set set) {
    present_.clear();
    history_ = 0;
    times_left_.resize(scene_.bodies.size());
    for (Set at = set; at != kOpenAir; at = nodes_[at].before, ++history_) {
      const Node& node = nodes_[at];
      if (node.is_left) {
        ++times_left_[node.body];
      } else if (times_left_[node.body] > 0) {
        --times_left_[node.body];
      } else {
        present_.push_back(node.body);
      }
    }
  }

  const CompiledScene& scene_;
  std::vector<Node> nodes_;
  std::vector<uint32_t> present_, times_left_;  // scratch of find_present; the latter by body, 0 between calls
  size_t history_ = 0;                          // nodes of the set that find_present saw
};

// The media on both sides of a place where a ray meets the surfaces of media, and which of them shows: the one that
// bounds the medium that counts on its side. Where both sides have one (glass on water) there is one interface from the
// one medium into the other, with the surface of the lower rank: what it is does not depend on the ray's way.
struct Crossing {
  MediaSets::Set before = MediaSets::kOpenAir, after = MediaSets::kOpenAir;
  uint32_t seen = kNone;  // the body whose surface shows; kNone: another medium fills both sides, the place is passed

  Crossing() = default;
  // The one surface of the place.
  Crossing(MediaSets& sets, MediaSets::Set media, uint32_t body, bool from_outside)
      : Crossing(sets, media, from_outside ? std::span(&body, 1) : std::span<uint32_t>(),
                 from_outside ? std::span<uint32_t>() : std::span(&body, 1), {}) {}
  // entered: outermost first. left: by rank. Both may name a body as often as it is crossed. thinner: bodies that are
  // entered and left in this very place, and are thin in it.
  Crossing(MediaSets& sets, MediaSets::Set media, std::span<const uint32_t> entered, std::span<const uint32_t> left,
           std::span<const uint32_t> thinner)
      : before(media) {
    for (const uint32_t body : left) {  // a body that is left without having been entered counts as entered
      if (!sets.contains(before, body)) before = sets.with(before, body);
    }
    after = before;
    for (const uint32_t body : left) {
      if (sets.contains(after, body)) after = sets.without(after, body);
    }
    for (const uint32_t body : entered) after = sets.with(after, body);
    for (const uint32_t body : left) show(sets, body, sets.top(before) == body);
    for (const uint32_t body : entered) show(sets, body, sets.top(after) == body);
    if (is_seen()) return;
    for (const uint32_t body : thinner) show(sets, body, sets.top(sets.with(before, body)) == body);
  }

  bool is_seen() const { return seen != kNone; }

 private:
  void show(const MediaSets& sets, uint32_t body, bool is_shown) {
    if (is_shown && (seen == kNone || sets.rank(body) < sets.rank(seen))) seen = body;
  }
};

}  // namespace tilelight
