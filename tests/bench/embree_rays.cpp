// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/embree_rays.h"

#include <dlfcn.h>
#include <embree3/rtcore.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "tests/bench/timing.h"

namespace tilelight::bench {
namespace {

using Clock = std::chrono::steady_clock;
double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

constexpr float kEpsilon = 1e-4f;  // where rays that leave a surface begin, normalised units
constexpr size_t kPacket = 16;

// Denormal numbers are zero on this thread, in operands and in results, until the end of the object's life.
class FlushedFloats {
 public:
  FlushedFloats() : before_(_mm_getcsr()) {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
  }
  ~FlushedFloats() { _mm_setcsr(before_); }
  FlushedFloats(const FlushedFloats&) = delete;
  FlushedFloats& operator=(const FlushedFloats&) = delete;

 private:
  const unsigned before_;
};

// Of the library's file, whether it can fail by an assertion. The dynamic symbol is there only if one was compiled in.
bool has_assertions() {
  Dl_info library{};
  if (!::dladdr(reinterpret_cast<const void*>(&rtcNewDevice), &library) || !library.dli_fname) return false;
  std::ifstream file(library.dli_fname, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  return bytes.find("__assert_fail") != std::string::npos;
}

RTCRay ray_of(const BoundedRay& in, bool any_hit) {
  RTCRay out{};
  out.org_x = static_cast<float>(in.ray.origin.x);
  out.org_y = static_cast<float>(in.ray.origin.y);
  out.org_z = static_cast<float>(in.ray.origin.z);
  out.dir_x = static_cast<float>(in.ray.direction.x);
  out.dir_y = static_cast<float>(in.ray.direction.y);
  out.dir_z = static_cast<float>(in.ray.direction.z);
  out.tnear = in.ray.left.body == kNone ? 0.0f : kEpsilon;
  out.tfar = in.t_max < 1e30 ? static_cast<float>(in.t_max) - (any_hit ? kEpsilon : 0.0f)
                             : std::numeric_limits<float>::infinity();
  out.mask = ~0u;
  return out;
}

void set_lane(RTCRayHit16& packet, size_t lane, const RTCRay& ray) {
  packet.ray.org_x[lane] = ray.org_x, packet.ray.org_y[lane] = ray.org_y, packet.ray.org_z[lane] = ray.org_z;
  packet.ray.dir_x[lane] = ray.dir_x, packet.ray.dir_y[lane] = ray.dir_y, packet.ray.dir_z[lane] = ray.dir_z;
  packet.ray.tnear[lane] = ray.tnear, packet.ray.tfar[lane] = ray.tfar, packet.ray.time[lane] = 0.0f;
  packet.ray.mask[lane] = ray.mask, packet.ray.id[lane] = 0, packet.ray.flags[lane] = 0;
  packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
}

}  // namespace

std::string embree_build() {
  const RTCDevice device = rtcNewDevice(nullptr);
  const auto property = [&](RTCDeviceProperty which) { return rtcGetDeviceProperty(device, which); };
  std::string out = "Embree " + std::to_string(property(RTC_DEVICE_PROPERTY_VERSION_MAJOR)) + "." +
                    std::to_string(property(RTC_DEVICE_PROPERTY_VERSION_MINOR)) + "." +
                    std::to_string(property(RTC_DEVICE_PROPERTY_VERSION_PATCH));
  out += property(RTC_DEVICE_PROPERTY_RAY_MASK_SUPPORTED) ? " (ray masks on, " : " (ray masks off, ";
  out += has_assertions() ? "assertions on)" : "assertions off)";
  rtcReleaseDevice(device);
  return out;
}

struct EmbreeTracer::State {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  double build_ms = 0.0;
  std::atomic<int64_t> bytes = 0;
};

// Rays and answers in one of Embree's layouts.
struct EmbreeTracer::Layout {
  std::vector<RTCRayHit> singles;
  std::vector<RTCRayHit16> packets;
};
struct EmbreeTracer::Part {
  bool any_hit = false, coherent = false;
  size_t kind = 0, count = 0;
  Layout layout;  // before they are traced
};

class EmbreeTracer::Job {
 public:
  EmbreeMode mode = EmbreeMode::single;
  size_t kinds = 0;
  std::vector<std::vector<Part>> pixels;
};

EmbreeTracer::EmbreeTracer(const CompiledScene& scene, int threads, bool robust) : state_(std::make_unique<State>()) {
  state_->device = rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
  rtcSetDeviceMemoryMonitorFunction(
      state_->device,
      [](void* bytes, ssize_t change, bool) {
        *static_cast<std::atomic<int64_t>*>(bytes) += change;
        return true;
      },
      &state_->bytes);
  state_->scene = rtcNewScene(state_->device);
  if (robust) rtcSetSceneFlags(state_->scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(state_->scene, RTC_BUILD_QUALITY_MEDIUM);
  for (size_t i = 0; i < scene.bodies.size(); ++i) {
    const CompiledBody& body = scene.bodies[i];
    if (body.kind != BodyKind::mesh) throw std::logic_error("Embree is shown meshes alone");
    const RTCGeometry geometry = rtcNewGeometry(state_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    const CompiledMesh& mesh = *body.mesh;
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), mesh.positions.size()));
    for (const Vec3& p : mesh.positions) {
      const Vec3 world = transform_point(body.world_from_local, p);
      for (int axis = 0; axis < 3; ++axis) *vertices++ = static_cast<float>(world[axis]);
    }
    auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(uint32_t), mesh.triangles.size()));
    for (const auto& triangle : mesh.triangles) indices = std::copy(triangle.begin(), triangle.end(), indices);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(state_->scene, geometry, static_cast<unsigned>(i));
    rtcReleaseGeometry(geometry);
  }
  const int64_t before = state_->bytes;
  const FlushedFloats floats;
  const auto start = Clock::now();
  rtcCommitScene(state_->scene);
  state_->build_ms = ms_since(start);
  state_->bytes -= before;  // what is left is the tree's
}

EmbreeTracer::~EmbreeTracer() {
  rtcReleaseScene(state_->scene);
  rtcSetDeviceMemoryMonitorFunction(state_->device, nullptr, nullptr);
  rtcReleaseDevice(state_->device);
}

double EmbreeTracer::build_ms() const { return state_->build_ms; }
int64_t EmbreeTracer::memory_bytes() const { return state_->bytes; }

EmbreeTracer::JobPtr EmbreeTracer::prepare(const FrameWaves& frame, EmbreeMode mode) const {
  auto job = std::make_shared<Job>();
  job->mode = mode;
  const std::vector<WaveKind> kinds = kinds_of(frame);
  job->kinds = kinds.size();
  for (const PixelWaves& waves : frame) {
    auto& parts = job->pixels.emplace_back();
    for (const Wave& wave : waves) {
      const auto kind = std::find_if(kinds.begin(), kinds.end(), [&](const WaveKind& k) {
        return k.depth == wave.depth && k.any_hit == wave.any_hit;
      });
      Part part{wave.any_hit, wave.depth == 0, static_cast<size_t>(kind - kinds.begin()), wave.rays.size(), {}};
      if (mode == EmbreeMode::packets) {
        part.layout.packets.resize((wave.rays.size() + kPacket - 1) / kPacket);
        for (size_t i = 0; i < part.layout.packets.size() * kPacket; ++i)
          set_lane(part.layout.packets[i / kPacket], i % kPacket,
                   ray_of(wave.rays[std::min(i, wave.rays.size() - 1)], wave.any_hit));
      } else {
        for (const BoundedRay& ray : wave.rays) {
          RTCRayHit single{};
          single.ray = ray_of(ray, wave.any_hit);
          single.hit.geomID = RTC_INVALID_GEOMETRY_ID;
          part.layout.singles.push_back(single);
        }
      }
      parts.push_back(std::move(part));
    }
  }
  return job;
}

void EmbreeTracer::trace(const Job& job, const Part& part, Layout& now) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = part.coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  switch (job.mode) {
    case EmbreeMode::single:
      for (RTCRayHit& ray : now.singles) {
        if (part.any_hit) {
          rtcOccluded1(state_->scene, &context, &ray.ray);
        } else {
          rtcIntersect1(state_->scene, &context, &ray);
        }
      }
      break;
    case EmbreeMode::packets:
      for (size_t k = 0; k < now.packets.size(); ++k) {
        alignas(64) int valid[kPacket];
        for (size_t lane = 0; lane < kPacket; ++lane) valid[lane] = k * kPacket + lane < part.count ? -1 : 0;
        if (part.any_hit) {
          rtcOccluded16(valid, state_->scene, &context, &now.packets[k].ray);
        } else {
          rtcIntersect16(valid, state_->scene, &context, &now.packets[k]);
        }
      }
      break;
    case EmbreeMode::stream:
      if (part.any_hit) {
        rtcOccluded1M(state_->scene, &context, &now.singles[0].ray, static_cast<unsigned>(part.count),
                      sizeof(RTCRayHit));
      } else {
        rtcIntersect1M(state_->scene, &context, now.singles.data(), static_cast<unsigned>(part.count),
                       sizeof(RTCRayHit));
      }
      break;
  }
}

std::vector<double> EmbreeTracer::run(const Job& job, TilePool& pool) const {
  std::vector<SpentTime> spent(job.kinds);
  pool.parallel_for(static_cast<int64_t>(job.pixels.size()), Priority::normal, [&](int64_t i) {
    thread_local Layout now;
    const FlushedFloats floats;
    for (const Part& part : job.pixels[static_cast<size_t>(i)]) {
      now = part.layout;
      spent[part.kind].spend([&] { trace(job, part, now); });
    }
  });
  std::vector<double> seconds;
  for (const SpentTime& of_kind : spent) seconds.push_back(of_kind.seconds() / pool.thread_count());
  return seconds;
}

double EmbreeTracer::differing(const Job& job, const CompiledScene& scene, const FrameWaves& frame) const {
  int64_t count = 0, others = 0;
  for (size_t b = 0; b < frame.size(); ++b) {
    const Part& part = job.pixels[b][0];
    Layout now = part.layout;
    {
      const FlushedFloats floats;
      trace(job, part, now);
    }
    std::vector<Hit> hits(part.count);
    trace_closest(scene, frame[b][0].rays, hits);
    for (size_t i = 0; i < hits.size(); ++i, ++count) {
      const bool is_packed = job.mode == EmbreeMode::packets;
      const uint32_t body = is_packed ? now.packets[i / kPacket].hit.geomID[i % kPacket] : now.singles[i].hit.geomID;
      const uint32_t prim = is_packed ? now.packets[i / kPacket].hit.primID[i % kPacket] : now.singles[i].hit.primID;
      others += body != hits[i].body || (hits[i].is_hit() && prim != hits[i].prim);
    }
  }
  return 100.0 * static_cast<double>(others) / static_cast<double>(std::max<int64_t>(1, count));
}

}  // namespace tilelight::bench
