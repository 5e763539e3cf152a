#include "bench/roofline/roofline.h"
#include "platform/machine.h"

// Highway compiles the text up to HWY_AFTER_NAMESPACE once for each instruction set, each time in a namespace
// of its own. Targets above AVX3, in lower bits, only add instructions that a triad does not use.
#define HWY_DISABLED_TARGETS (HWY_AVX3 - 1)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/roofline/machine_peak.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef MSSIM_BENCH_MACHINE_PEAK_ONCE
#define MSSIM_BENCH_MACHINE_PEAK_ONCE
namespace mssim {
/// Length of the triad's arrays is a multiple of this many floats: four vectors of the widest kind.
inline constexpr std::size_t triad_block = 128;
}  // namespace mssim
#endif

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Computes a = b + s c over arrays of `size` floats, a multiple of triad_block, `passes` times. `stream`:
/// stores bypass the caches.
void triad(float* HWY_RESTRICT a, const float* HWY_RESTRICT b, const float* HWY_RESTRICT c, std::size_t size,
           std::size_t passes, bool stream) {
  const hn::CappedTag<float, triad_block / 4> d;
  const std::size_t lanes = hn::Lanes(d);
  const auto s = hn::Set(d, 0.5F);
  for (std::size_t pass = 0; pass < passes; ++pass) {
    if (stream) {
      for (std::size_t i = 0; i < size; i += lanes)
        hn::Stream(hn::MulAdd(s, hn::Load(d, c + i), hn::Load(d, b + i)), d, a + i);
    } else {
      for (std::size_t i = 0; i < size; i += 4 * lanes) {
        for (std::size_t k = i; k < i + 4 * lanes; k += lanes)
          hn::Store(hn::MulAdd(s, hn::Load(d, c + k), hn::Load(d, b + k)), d, a + k);
      }
    }
    // Keeps the compiler from removing all passes but the last.
    asm volatile("" : : "r"(a) : "memory");
  }
  if (stream) hwy::FlushStream();
}

/// Multiply-adds in independent chains, `rounds` in each. Twelve chains keep two units of latency four to six
/// busy and fit into sixteen registers. Returns the number of floating-point operations.
double multiply_adds(std::size_t rounds, float* HWY_RESTRICT result) {
  const hn::ScalableTag<float> d;
  const auto m = hn::Set(d, 0.5F);
  const auto a = hn::Set(d, 1.0F);
  auto c0 = hn::Iota(d, 0), c1 = hn::Iota(d, 1), c2 = hn::Iota(d, 2), c3 = hn::Iota(d, 3);
  auto c4 = hn::Iota(d, 4), c5 = hn::Iota(d, 5), c6 = hn::Iota(d, 6), c7 = hn::Iota(d, 7);
  auto c8 = hn::Iota(d, 8), c9 = hn::Iota(d, 9), c10 = hn::Iota(d, 10), c11 = hn::Iota(d, 11);
  for (std::size_t round = 0; round < rounds; ++round) {
    c0 = hn::MulAdd(c0, m, a), c1 = hn::MulAdd(c1, m, a), c2 = hn::MulAdd(c2, m, a);
    c3 = hn::MulAdd(c3, m, a), c4 = hn::MulAdd(c4, m, a), c5 = hn::MulAdd(c5, m, a);
    c6 = hn::MulAdd(c6, m, a), c7 = hn::MulAdd(c7, m, a), c8 = hn::MulAdd(c8, m, a);
    c9 = hn::MulAdd(c9, m, a), c10 = hn::MulAdd(c10, m, a), c11 = hn::MulAdd(c11, m, a);
  }
  c0 = hn::Add(hn::Add(hn::Add(c0, c1), hn::Add(c2, c3)), hn::Add(hn::Add(c4, c5), hn::Add(c6, c7)));
  c0 = hn::Add(c0, hn::Add(hn::Add(c8, c9), hn::Add(c10, c11)));
  *result = hn::GetLane(hn::SumOfLanes(d, c0));
  return 2.0 * 12.0 * static_cast<double>(rounds) * static_cast<double>(hn::Lanes(d));
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <hwy/aligned_allocator.h>
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <new>
#include <vector>

namespace mssim {
namespace {

HWY_EXPORT(triad);
HWY_EXPORT(multiply_adds);

using Clock = std::chrono::steady_clock;

/// Wall seconds from the first thread's start until `work(part)` has finished for every part. Each thread
/// takes one part. All threads exist before the first starts; waiting for them is not counted. If the runtime
/// grants fewer threads, some take more parts, and the time includes that.
template <class Work>
double timed_on(int threads, const Work& work) {
  Clock::time_point first_start = Clock::time_point::max(), last_end = Clock::time_point::min();
  const int team = openmp_team(threads);
#pragma omp parallel num_threads(team)
  {
#pragma omp barrier
    const Clock::time_point start = Clock::now();
    for (int part = omp_get_thread_num(); part < threads; part += omp_get_num_threads())
      work(static_cast<std::size_t>(part));
    const Clock::time_point end = Clock::now();
#pragma omp critical(mssim_machine_peak)
    {
      first_start = std::min(first_start, start);
      last_end = std::max(last_end, end);
    }
  }
  return std::chrono::duration<double>(last_end - first_start).count();
}

/// The best rate (amount per second, all threads together) of `work(part, repeats)`, which processes `amount`
/// `repeats` times. The number of repetitions makes a sample long relative to its start and end. It is found
/// on one thread, because on a busy machine the time of several includes their waiting.
template <class Work>
double best_rate(int threads, double amount, const Work& work) {
  constexpr double sample_seconds = 1e-3, total_seconds = 0.05;
  constexpr int least_samples = 3;
  std::size_t repeats = 1;
  for (int long_enough = 0; long_enough < 2;) {
    const Stopwatch watch;
    work(0, repeats);
    if (watch.seconds() >= sample_seconds) {
      ++long_enough;  // twice, because one may be an interruption
    } else {
      repeats *= 2;
      long_enough = 0;
    }
  }
  double best = std::numeric_limits<double>::infinity();
  const Stopwatch all;
  for (int sample = 0; sample < least_samples || all.seconds() < total_seconds; ++sample)
    best = std::min(best, timed_on(threads, [&](std::size_t part) { work(part, repeats); }));
  return amount * static_cast<double>(repeats) * threads / best;
}

/// The part of the triad's arrays that one thread processes.
struct TriadPart {
  hwy::AlignedFreeUniquePtr<float[]> a, b, c;
};

double triad_bandwidth(int threads, std::size_t working_set_bytes) {
  constexpr std::size_t largest = std::size_t{128} << 20;
  const std::size_t thread_count = static_cast<std::size_t>(threads);
  const std::size_t blocks =
      std::min(working_set_bytes, largest) / (3 * sizeof(float) * triad_block * thread_count);
  const std::size_t size = triad_block * std::max<std::size_t>(blocks, 1);
  std::vector<TriadPart> parts(thread_count);
  for (TriadPart& part : parts)
    for (auto* array : {&part.a, &part.b, &part.c}) {
      *array = hwy::AllocateAligned<float>(size);
      if (!*array) throw std::bad_alloc();
    }
  // Each thread touches its part first, so that the pages are on its NUMA node.
  timed_on(threads, [&](std::size_t thread) {
    TriadPart& part = parts[thread];
    std::fill_n(part.a.get(), size, 0.0F);
    std::fill_n(part.b.get(), size, 1.0F);
    std::fill_n(part.c.get(), size, 2.0F);
  });
  double best = 0;
  for (const bool stream : {false, true}) {
    const double rate = best_rate(threads, static_cast<double>(3 * sizeof(float) * size),
                                  [&](std::size_t part, std::size_t passes) {
                                    const TriadPart& arrays = parts[part];
                                    HWY_DYNAMIC_DISPATCH(triad)
                                    (arrays.a.get(), arrays.b.get(), arrays.c.get(), size, passes, stream);
                                  });
    best = std::max(best, rate);
  }
  return best;
}

double multiply_add_rate(int threads) {
  constexpr std::size_t rounds = 1000;
  struct alignas(64) Result {
    float value = 0;
  };
  std::vector<Result> results(static_cast<std::size_t>(threads));
  const double operations = HWY_DYNAMIC_DISPATCH(multiply_adds)(rounds, &results[0].value);
  return best_rate(threads, operations, [&](std::size_t part, std::size_t repeats) {
    HWY_DYNAMIC_DISPATCH(multiply_adds)(repeats * rounds, &results[part].value);
  });
}

}  // namespace

MachinePeak measure_peak(int threads, std::size_t working_set_bytes) {
  return {triad_bandwidth(threads, working_set_bytes), multiply_add_rate(threads)};
}

double roofline_fraction(const StepCost& cost, double seconds, const MachinePeak& peak) {
  return std::max(cost.bytes / peak.bytes_per_second, cost.flops / peak.flops_per_second) / seconds;
}

}  // namespace mssim
#endif  // HWY_ONCE
