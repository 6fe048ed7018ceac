#pragma once
#include <iosfwd>
#include <optional>
#include <string>

#include "carve/mesh/textured_mesh.h"
#include "carve/views/view_set.h"

namespace carve {

/// How good an atlas is as such.
struct AtlasScores {
  std::int64_t charts = 0;   // sets of triangles that share texture coordinates
  double packing = 0;        // share of the texture's area that triangles cover
  double distortion = 0;     // mean symmetric Dirichlet energy by area, all charts at one scale; 4 = isometric
  std::int64_t flipped = 0;  // triangles laid out face down or without area; left out of the distortion
  std::int64_t overlap = 0;  // texels whose centre lies inside two triangles
  std::int64_t outside = 0;  // texture coordinates that are not in [0, 1]
  double seam_length = 0;    // of the mesh's edges along which coordinates differ, model units
  double seam_contrast = 0;  // mean RGB distance between the two sides of seams, by length
};

/// The textured model drawn in the drawings' own views, against the drawings; all views together. Compared are whole
/// pixels of surface that the model covers, away by two pixels from strokes and background, which a texture leaves out.
struct RoundTrip {
  std::optional<double> psnr;      // of the pixels that no other drawing sees more squarely, dB; of equal pictures 100
  std::optional<double> psnr_all;  // of all, also where drawings may contradict each other
  std::optional<double> psnr_raw;  // of everything drawn that the model covers, strokes and rims too
  std::optional<double> ssim;      // of grey values, 7 x 7 pixels, at the pixels of psnr
  /// Share of the seen pixels whose colour is none that a drawing shows there or one pixel beside (RGB distance above
  /// 24): mixtures of drawings that differ.
  std::optional<double> ghosting;
};

AtlasScores atlas_scores(const TexturedMesh& model);
/// \param model  in the drawings' object units \throws std::invalid_argument if there is no texture
RoundTrip round_trip(const TexturedMesh& model, const ViewSet& views);
/// A row a drawing, as far as it is drawn on: the drawing, the model seen in it, their difference at the pixels of psnr
/// and at the others of psnr_all (dark: none, yellow: RGB distance of 128 or more, white: not compared).
Picture differences(const TexturedMesh& model, const ViewSet& views);

std::ostream& operator<<(std::ostream& out, const AtlasScores& scores);  // a line a field
std::ostream& operator<<(std::ostream& out, const RoundTrip& scores);

}  // namespace carve
