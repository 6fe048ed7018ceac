#include <benchmark/benchmark.h>

#include "carve/image/drawing.h"
#include "carve/image/read_image.h"
#include "image/encoders.h"
#include "image/sketch.h"

namespace carve {
namespace {

constexpr Rgba kWhite{255, 255, 255, 255}, kBlack{0, 0, 0, 255}, kRed{200, 60, 40, 255}, kTeal{40, 130, 140, 255};

// A body with outline, wheels and a hole, drawn at 512 and enlarged: what an artist's file has most of, flat colours.
Picture sample(int size) {
  const Shape body = blob({256, 256}, 220, kTeal, 1), part = blob({290, 230}, 60, kRed, 2);
  const Shape hole = disc({200, 310}, 40, {0, 0, 0, 0});
  const Sketch sketch{
      body, outline(body, 4), part, outline(part, 4), hole, outline(hole, 4), disc({330, 340}, 40, kBlack)};
  return enlarged(drawn(sketch, 512, 512), size / 512);
}

void DecodePng(benchmark::State& state) {
  const std::string bytes = encode_png(sample(static_cast<int>(state.range(0))));
  for (auto _ : state) benchmark::DoNotOptimize(decode_image(bytes, "a"));
}
BENCHMARK(DecodePng)->Arg(512)->Arg(4096)->Arg(16384)->Unit(benchmark::kMillisecond);

void EncodePng(benchmark::State& state) {
  const Picture picture = sample(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(encode_png(picture));
}
BENCHMARK(EncodePng)->Arg(512)->Arg(4096)->Unit(benchmark::kMillisecond);

void label(benchmark::State& state, const Picture& picture) {
  for (auto _ : state) {
    state.PauseTiming();
    Picture copy = picture;
    state.ResumeTiming();
    benchmark::DoNotOptimize(understand_drawing(std::move(copy)));
  }
}

void LabelByAlpha(benchmark::State& state) { label(state, sample(static_cast<int>(state.range(0)))); }
BENCHMARK(LabelByAlpha)->Arg(512)->Arg(4096)->Arg(16384)->Unit(benchmark::kMillisecond);

void LabelOnPaper(benchmark::State& state) { label(state, on_paper(sample(static_cast<int>(state.range(0))), kWhite)); }
BENCHMARK(LabelOnPaper)->Arg(512)->Arg(4096)->Arg(16384)->Unit(benchmark::kMillisecond);

void LabelJpeg(benchmark::State& state) {
  const Picture clean = on_paper(sample(static_cast<int>(state.range(0))), kWhite);
  label(state, decode_image(jpeg_file(samples_of(clean, 3), {.quality = 75, .full_colour = false}), "a"));
}
BENCHMARK(LabelJpeg)->Arg(512)->Arg(4096)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace carve
