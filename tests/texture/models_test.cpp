// Every procedural model from its drawings to its texture, at a small grid.
#include <gmock/gmock.h>

#include "carve/pipeline/reconstruct.h"
#include "eval/texture_scores.h"
#include "models/procedural.h"
#include "synthesize/synthesize.h"

namespace carve {
namespace {

class TextureOfModels : public ::testing::TestWithParam<ProceduralModel> {};
INSTANTIATE_TEST_SUITE_P(Models, TextureOfModels,
                         ::testing::ValuesIn(procedural_models().begin(), procedural_models().end()),
                         [](const auto& info) { return info.param.name; });

TEST_P(TextureOfModels, IsLaidOutSoundlyAndShowsTheDrawings) {
  std::map<View, Drawing> drawings;
  for (auto& [view, picture] : synthesize(GetParam().make(), {.size = 256, .samples = 2}))
    drawings[view] = understand_drawing(std::move(picture));
  for (const AtlasArm arm : {AtlasArm::view_charts, AtlasArm::clusters}) {
    PipelineOptions options;
    options.carve.grid = 48;
    options.texture.arm = TextureArm::best_view;
    options.atlas.arm = arm;
    options.atlas.size = 512;
    const Reconstruction result = reconstruct(drawings, options);
    const AtlasScores scores = atlas_scores(result.textured);
    EXPECT_EQ(scores.overlap, 0);
    EXPECT_EQ(scores.outside, 0);
    EXPECT_EQ(scores.flipped, 0);
    if (arm == AtlasArm::clusters) {
      EXPECT_LE(scores.distortion, 4.1);
    }
    EXPECT_GE(*round_trip(result.textured, result.views).psnr, 30);
  }
}

}  // namespace
}  // namespace carve
