// SPDX-License-Identifier: Apache-2.0
#include "renderer/geometry/knight_form.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tilelight {
namespace {

// Quadratic smooth minimum: differs from min only where |a - b| < reach.
double join(double a, double b, double reach) {
  const double h = std::max(reach - std::fabs(a - b), 0.0) / reach;
  return std::min(a, b) - 0.25 * reach * h * h;
}
double carve(double solid, double tool, double reach) { return -join(-solid, tool, reach); }

// 1 inside, 0 beyond the border, a smooth step of the given width between.
double fade(double distance, double border, double width) {
  const double t = std::clamp((border - distance) / width + 0.5, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

struct FormPoint {
  double side, up, fore;
};

// A station of a limb in the plane of symmetry, with its radius there and its half width across.
struct Station {
  double fore, up, radius, width;
};

double limb(const FormPoint& p, const Station& a, const Station& b) {
  const Vec2 pa(p.fore - a.fore, p.up - a.up), ba(b.fore - a.fore, b.up - a.up);
  const double h = std::clamp(glm::dot(pa, ba) / glm::dot(ba, ba), 0.0, 1.0);
  const Vec2 q = pa - h * ba;
  const double r = a.radius + h * (b.radius - a.radius), w = a.width + h * (b.width - a.width);
  const double side = p.side * r / w;
  return std::sqrt(glm::dot(q, q) + side * side) - r;
}

struct Ball {
  Vec3 center;  // (side, up, fore)
  Vec3 radii;
};

// Exact to first order at the surface.
double ball(const FormPoint& p, const Ball& b) {
  const Vec3 q = Vec3(p.side, p.up, p.fore) - b.center;
  const double k0 = glm::length(q / b.radii), k1 = glm::length(q / (b.radii * b.radii));
  return k1 > 0.0 ? k0 * (k0 - 1.0) / k1 : -std::min({b.radii.x, b.radii.y, b.radii.z});
}

// A straight tapering rod in space.
struct Rod {
  Vec3 from, to;  // (side, up, fore)
  double from_radius, to_radius;
};

double rod(const FormPoint& p, const Rod& r) {
  const Vec3 pa = Vec3(p.side, p.up, p.fore) - r.from, ba = r.to - r.from;
  const double h = std::clamp(glm::dot(pa, ba) / glm::dot(ba, ba), 0.0, 1.0);
  return glm::length(pa - h * ba) - (r.from_radius + h * (r.to_radius - r.from_radius));
}

// Level sections of chest and neck, ellipses kNeckStep apart from kNeckFoot upwards.
struct Slice {
  double fore, depth, width;
};
constexpr double kNeckFoot = 0.30, kNeckStep = 0.10;
constexpr std::array<Slice, 10> kNeck{{{0.000, 0.224, 0.214},
                                       {0.000, 0.224, 0.202},
                                       {0.004, 0.232, 0.186},
                                       {-0.010, 0.224, 0.162},
                                       {-0.042, 0.182, 0.134},
                                       {-0.064, 0.149, 0.110},
                                       {-0.064, 0.136, 0.097},
                                       {-0.030, 0.134, 0.092},
                                       {0.015, 0.110, 0.086},
                                       {0.030, 0.050, 0.050}}};
constexpr std::array<Station, 4> kSkull{{{0.050, 1.105, 0.102, 0.086},
                                         {0.130, 1.035, 0.104, 0.084},
                                         {0.228, 0.920, 0.076, 0.064},
                                         {0.302, 0.832, 0.060, 0.054}}};
// The crest of the mane, from the poll down to the back.
constexpr std::array<Station, 7> kCrest{{{0.020, 1.182, 0.052, 0.048},
                                         {-0.055, 1.130, 0.072, 0.058},
                                         {-0.126, 1.030, 0.084, 0.067},
                                         {-0.168, 0.900, 0.088, 0.074},
                                         {-0.180, 0.740, 0.088, 0.080},
                                         {-0.172, 0.560, 0.088, 0.086},
                                         {-0.162, 0.340, 0.086, 0.092}}};

double catmull_rom(double a, double b, double c, double d, double t) {
  return b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)));
}

double neck(const FormPoint& p) {
  const double at = std::clamp((p.up - kNeckFoot) / kNeckStep, 0.0, double(kNeck.size() - 1));
  const size_t i = std::min(static_cast<size_t>(at), kNeck.size() - 2);
  const double t = at - double(i);
  const Slice &s0 = kNeck[i > 0 ? i - 1 : 0], &s1 = kNeck[i], &s2 = kNeck[i + 1],
              &s3 = kNeck[std::min(i + 2, kNeck.size() - 1)];
  const double fore = p.fore - catmull_rom(s0.fore, s1.fore, s2.fore, s3.fore, t);
  const double depth = std::max(0.004, catmull_rom(s0.depth, s1.depth, s2.depth, s3.depth, t));
  const double width = std::max(0.004, catmull_rom(s0.width, s1.width, s2.width, s3.width, t));
  const double above = p.up - (kNeckFoot + kNeckStep * double(kNeck.size() - 1));
  const double k0 = std::sqrt((fore / depth) * (fore / depth) + (p.side / width) * (p.side / width));
  const double k1 = std::sqrt((fore / (depth * depth)) * (fore / (depth * depth)) +
                              (p.side / (width * width)) * (p.side / (width * width)));
  const double level = k1 > 0.0 ? k0 * (k0 - 1.0) / k1 : -std::min(depth, width);
  const double d = std::max(level, above);
  const Ball breast{{0.080, 0.500, 0.130}, {0.080, 0.130, 0.092}};
  return join(d, ball(p, breast), 0.05);
}

// The mane: a ridge along the crest, cut into locks that fall from it to both sides.
double mane(const FormPoint& p) {
  double d = 1e9, along = 0.0, walked = 0.0;
  for (size_t i = 0; i + 1 < kCrest.size(); ++i) {
    const Station &a = kCrest[i], &b = kCrest[i + 1];
    const Vec2 pa(p.fore - a.fore, p.up - a.up), ba(b.fore - a.fore, b.up - a.up);
    const double length = glm::length(ba), h = std::clamp(glm::dot(pa, ba) / (length * length), 0.0, 1.0);
    const double di = limb(p, a, b);
    if (di < d) along = walked + h * length;
    d = std::min(d, di);
    walked += length;
  }
  constexpr double kLock = 0.120, kSlant = 0.7, kGroove = 0.018, kSoftness = 0.12;
  const double phase = (along - kSlant * p.side) / kLock;
  const double from_groove = 1.0 - std::fabs(2.0 * (phase - std::floor(phase)) - 1.0);  // 1 in the middle of a lock
  const double t = 1.0 + kSoftness - std::sqrt(from_groove * from_groove + kSoftness * kSoftness);
  return d + kGroove * t * t - 0.004;
}

double head(const FormPoint& p) {
  double d = limb(p, kSkull[0], kSkull[1]);
  d = join(d, limb(p, kSkull[1], kSkull[2]), 0.05);
  d = join(d, limb(p, kSkull[2], kSkull[3]), 0.04);
  const Ball cheek{{0.034, 0.928, 0.120}, {0.080, 0.120, 0.108}};
  const Rod jaw{{0.022, 0.856, 0.160}, {0.014, 0.796, 0.272}, 0.054, 0.038};
  const Rod cheekbone{{0.070, 1.005, 0.180}, {0.048, 0.900, 0.268}, 0.020, 0.012};
  const Ball nose{{0.032, 0.850, 0.322}, {0.040, 0.052, 0.048}};
  const Ball lip{{0.012, 0.806, 0.324}, {0.044, 0.034, 0.042}};
  const Ball chin{{0.0, 0.774, 0.284}, {0.040, 0.034, 0.040}};
  d = join(d, ball(p, cheek), 0.016);
  d = join(d, rod(p, jaw), 0.045);
  d = join(d, rod(p, cheekbone), 0.020);
  d = join(d, ball(p, nose), 0.025);
  d = join(d, ball(p, lip), 0.025);
  return join(d, ball(p, chin), 0.025);
}

double eye_and_brow(const FormPoint& p, double d) {
  const Ball socket{{0.122, 1.042, 0.180}, {0.050, 0.052, 0.074}};
  const Ball eyeball{{0.055, 1.049, 0.181}, {0.034, 0.032, 0.042}};
  const Rod brow{{0.052, 1.102, 0.124}, {0.048, 1.096, 0.184}, 0.026, 0.022};
  d = join(d, rod(p, brow), 0.050);
  d = carve(d, ball(p, socket), 0.055);
  return join(d, ball(p, eyeball), 0.012);
}

double mouth_and_nostril(const FormPoint& p, double d) {
  // The line of the lips in the plane of symmetry, cut in as a groove from both sides and the front.
  const Vec2 from(0.250, 0.836), to(0.380, 0.780), line = to - from, q(p.fore - from.x, p.up - from.y);
  const double h = std::clamp(glm::dot(q, line) / glm::dot(line, line), 0.0, 1.0);
  const double off = glm::length(q - h * line);
  const double depth = 0.024 * std::min(1.0, 0.25 + 4.0 * h) * (1.0 - 0.55 * h);  // dying out at the corner of the lips
  d += depth * fade(off, 0.010, 0.020);
  const Ball nostril{{0.070, 0.862, 0.340}, {0.020, 0.018, 0.024}};
  return carve(d, ball(p, nostril), 0.012);
}

double ear(const FormPoint& p) {
  const Rod lower{{0.046, 1.140, 0.048}, {0.058, 1.212, 0.058}, 0.034, 0.037};
  const Rod upper{{0.058, 1.212, 0.058}, {0.062, 1.298, 0.082}, 0.037, 0.006};
  const Rod hollow{{0.066, 1.190, 0.104}, {0.066, 1.290, 0.104}, 0.030, 0.008};
  return carve(join(rod(p, lower), rod(p, upper), 0.004), rod(p, hollow), 0.010);
}

}  // namespace

double knight_form(const Vec3& point) {
  const FormPoint p{std::fabs(point.x), point.y, -point.z};
  constexpr double kFar = 0.05;  // parts farther than this need no evaluation: they blend over less
  double d = p.fore < 0.16 ? join(neck(p), mane(p), 0.016) : std::min(neck(p), kFar);
  if (p.up < 0.68) return std::min(d, kFar);
  d = join(d, head(p), 0.022);
  d = eye_and_brow(p, d);
  d = mouth_and_nostril(p, d);
  return p.up > 1.04 ? join(d, ear(p), 0.018) : d;
}

}  // namespace tilelight
