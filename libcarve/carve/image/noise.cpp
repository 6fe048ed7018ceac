#include <algorithm>

#include "carve/image/labelling.h"

namespace carve::labelling {
namespace {

// Gives the pixels of value `from` the value `to` wherever, within what connects them, they fill a square of
// 2 radius + 1 pixels.
void turn_areas(Mask& places, std::uint8_t from, std::uint8_t to, int radius) {
  Mask others(places.width, places.height);
  std::transform(places.pixels.begin(), places.pixels.end(), others.pixels.begin(), [=](int p) { return p != from; });
  Neighbourhood near_others(others, radius);
  Flood flood(places);
  for (int y = 0; y < places.height; ++y) {
    const std::uint8_t* near = near_others.row(y);
    for (int x = 0; x < places.width; ++x)
      if (!near[x] && places(x, y) == from) flood(x, y, from, to);
  }
}

}  // namespace

// A lossy format leaves ripples beside every border: nearly paper-coloured pixels lighter, or darker, than both their
// neighbours in the row or column. Clean drawings have hardly any, since their colours run one way from paper to
// object.
bool has_ripples(const Picture& picture, const Mask& places) {
  std::size_t borders = 0, ripples = 0;
  const auto look = [&](std::size_t i, std::size_t step) {
    if (same(picture.pixels[i], picture.pixels[i + step]) || places.pixels[i] == object) return;
    borders += places.pixels[i + step] == object;
    if (places.pixels[i - step] == object || places.pixels[i + step] == object) return;
    const int here = brightness(picture.pixels[i]);
    const int before = here - brightness(picture.pixels[i - step]), after = here - brightness(picture.pixels[i + step]);
    ripples += before * after > 0;
  };
  const std::size_t width = picture.width;
  for (int y = 1; y + 1 < picture.height; ++y)
    for (std::size_t i = y * width + 1; i + 1 < (y + 1) * width; ++i) {
      look(i, 1);
      look(i, width);
    }
  return 4 * ripples > borders;
}

// Lossy formats: pale pixels are the object's where they make an area of 5 x 5, else ripples on the paper; small specks
// are ripples too; and enclosed paper narrower than 5 pixels is overshoot within the object's light colours.
void clear_noise(Mask& places) {
  turn_areas(places, faint, object, 2);
  replace(places, faint, enclosed);
  clear_specks(places, object, enclosed, kLargestSpeck);
  flood_from_border(places);
  turn_areas(places, enclosed, seen, 2);
  replace(places, enclosed, object);
  replace(places, seen, enclosed);
}

}  // namespace carve::labelling
