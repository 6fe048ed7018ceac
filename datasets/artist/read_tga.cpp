#include "artist/bytes.h"
#include "artist/readers.h"

namespace carve::artist {

Picture read_tga(std::string_view data, const std::string& name) {
  const Bytes file(data, name);
  const int kind = file.get<std::uint8_t>(2), bits = file.get<std::uint8_t>(16);
  const int width = file.get<std::uint16_t>(12), height = file.get<std::uint16_t>(14);
  if (file.get<std::uint8_t>(1) != 0 || (kind != 2 && kind != 10) || (bits != 24 && bits != 32))
    file.fail("not a Targa picture in true colour");
  if (width < 1 || height < 1 || width > 16384 || height > 16384) file.fail("a side is not in [1, 16384] pixels");
  const bool top_down = (file.get<std::uint8_t>(17) & 0x20) != 0;
  const int size = bits / 8;
  std::int64_t at = 18 + file.get<std::uint8_t>(0);
  const std::int64_t pixels = std::int64_t{width} * height;
  if (kind == 2)
    file.check(at, pixels, size, "pixels");
  else
    file.check(at, (pixels + 127) / 128, 1 + size, "packets");  // the fewest bytes that can hold them

  Picture picture(width, height);
  std::int64_t run = kind == 2 ? pixels : 0;  // pixels left in this packet
  bool repeat = false, fresh = true;          // one colour for all of them; it is still to be read
  Rgba colour;
  for (std::int64_t i = 0; i < pixels; ++i) {
    if (run == 0) {
      const int packet = file.get<std::uint8_t>(at++);
      run = (packet & 0x7f) + 1;
      repeat = (packet & 0x80) != 0;
      fresh = true;
    }
    if (fresh) {
      colour = {file.get<std::uint8_t>(at + 2), file.get<std::uint8_t>(at + 1), file.get<std::uint8_t>(at),
                size == 4 ? file.get<std::uint8_t>(at + 3) : std::uint8_t{255}};
      at += size;
      fresh = !repeat;
    }
    const int x = static_cast<int>(i % width), y = static_cast<int>(i / width);
    picture(x, top_down ? y : height - 1 - y) = colour;
    --run;
  }
  return picture;
}

}  // namespace carve::artist
