#include "carve/image/read_image.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <tiffio.h>
#include <unistd.h>

#include <fstream>
#include <random>

#include "carve/core/error.h"
#include "carve/core/file.h"
#include "image/encoders.h"
#include "temporary_folder.h"

namespace carve {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

Picture decoded(const std::string& bytes) { return decode_image(bytes, "a"); }

std::string error_of(const std::string& bytes) {
  try {
    decode_image(bytes, "a");
  } catch (const IoError& error) {
    return error.what();
  }
  return "no error";
}

int largest_difference(const Picture& a, const Picture& b) {
  if (a.width != b.width || a.height != b.height) return 256;
  int largest = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const Rgba p = a.pixels[i], q = b.pixels[i];
    largest = std::max({largest, std::abs(p.r - q.r), std::abs(p.g - q.g), std::abs(p.b - q.b), std::abs(p.a - q.a)});
  }
  return largest;
}

// A picture that lossy formats keep well.
Picture smooth_picture(int width, int height) {
  Picture picture(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      picture(x, y) = {static_cast<std::uint8_t>(255 * x / width), static_cast<std::uint8_t>(255 * y / height),
                       static_cast<std::uint8_t>(128 + 60 * x / width - 60 * y / height),
                       static_cast<std::uint8_t>(255 - 200 * y / height)};
  return picture;
}

Picture opaque(Picture picture) {
  for (Rgba& p : picture.pixels) p.a = 255;
  return picture;
}

// One file of each format and kind, of about 20 x 17 pixels.
std::vector<std::pair<std::string, std::string>> samples_of_all_formats(unsigned seed) {
  const Picture picture = smooth_picture(20, 17);
  const Samples rgba = random_samples(20, 17, 4, 8, seed);
  const Samples rgb = samples_of(opaque(picture), 3);
  return {{"png", png_file(rgba)},
          {"interlaced png", png_file(rgba, {.interlaced = true})},
          {"16-bit png", png_file(random_samples(20, 17, 3, 16, seed))},
          {"palette png",
           png_file(random_samples(20, 17, 1, 2, seed), {.palette = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9, 0}, {}}})},
          {"jpeg", jpeg_file(rgb)},
          {"progressive jpeg", jpeg_file(rgb, {.progressive = true, .orientation = 6})},
          {"cmyk jpeg", jpeg_file(rgba)},
          {"tiff", tiff_file(rgba, {.alpha = TiffLook::Alpha::straight})},
          {"lzw tiff", tiff_file(rgba, {.alpha = TiffLook::Alpha::associated, .compression = COMPRESSION_LZW})},
          {"deflate tiff", tiff_file(random_samples(20, 17, 3, 16, seed), {.compression = COMPRESSION_ADOBE_DEFLATE})},
          {"tiled tiff", tiff_file(rgb, {.compression = COMPRESSION_PACKBITS, .tiled = true, .big_endian = true})},
          {"palette tiff", tiff_file(random_samples(20, 17, 1, 4, seed), {.palette = {{1, 2, 3}, {4, 5, 6}}})},
          {"jpeg tiff", tiff_file(rgb, {.compression = COMPRESSION_JPEG, .tiled = true})},
          {"webp", webp_file(picture, false)},
          {"lossless webp", webp_file(picture_of(rgba), true)},
          {"opaque webp", webp_file(opaque(picture), false)}};
}

// What the process writes to its error stream while this lives.
class ErrorStream {
 public:
  explicit ErrorStream(const std::filesystem::path& path) : path_(path), kept_(dup(2)) {
    const int file = open(path.c_str(), O_CREAT | O_RDWR | O_TRUNC, 0600);
    dup2(file, 2);
    close(file);
  }
  ~ErrorStream() {
    dup2(kept_, 2);
    close(kept_);
  }
  std::string text() const { return read_file(path_); }

 private:
  std::filesystem::path path_;
  int kept_;
};

// ---- every variant is read exactly ---------------------------------------------------------------------------------

struct Depth {
  int channels, bits;
};
class PngTest : public ::testing::TestWithParam<Depth> {};

TEST_P(PngTest, EverySampleIsRead) {
  const auto [channels, bits] = GetParam();
  for (const bool interlaced : {false, true})
    for (const auto& [width, height] : {std::pair{1, 1}, {2, 9}, {33, 7}, {64, 40}}) {
      const Samples samples = random_samples(width, height, channels, bits, 7 * width + bits);
      EXPECT_EQ(decoded(png_file(samples, {.interlaced = interlaced})), picture_of(samples))
          << width << " x " << height << (interlaced ? " interlaced" : "");
    }
}
INSTANTIATE_TEST_SUITE_P(Depths, PngTest,
                         ::testing::Values(Depth{1, 1}, Depth{1, 2}, Depth{1, 4}, Depth{1, 8}, Depth{1, 16},
                                           Depth{2, 8}, Depth{2, 16}, Depth{3, 8}, Depth{3, 16}, Depth{4, 8},
                                           Depth{4, 16}));

TEST(Png, PaletteColoursAndTheirAlphaAreLookedUp) {
  for (const int bits : {1, 2, 4, 8}) {
    std::vector<Rgba> palette;
    for (const auto v : random_samples(1 << bits, 1, 1, 8, 3).values)
      palette.push_back({static_cast<std::uint8_t>(v), static_cast<std::uint8_t>(v * 7),
                         static_cast<std::uint8_t>(v * 31), static_cast<std::uint8_t>(v * 57)});
    const Samples samples = random_samples(19, 11, 1, bits, bits);
    const Picture picture = decoded(png_file(samples, {.palette = palette}));
    for (int y = 0; y < 11; ++y)
      for (int x = 0; x < 19; ++x) EXPECT_EQ(picture(x, y), palette[samples(x, y, 0)]);
  }
}

TEST(Png, TheTransparentColourGetsAlphaZero) {
  for (const auto& [channels, bits] : {std::pair{1, 2}, {1, 8}, {1, 16}, {3, 8}, {3, 16}}) {
    Samples samples = random_samples(19, 11, channels, bits, bits);
    std::vector<int> transparent;
    for (int c = 0; c < channels; ++c) transparent.push_back(samples(5, 5, c));
    const Picture picture = decoded(png_file(samples, {.transparent = transparent}));
    EXPECT_EQ(picture(5, 5).a, 0);
    for (int y = 0; y < 11; ++y)
      for (int x = 0; x < 19; ++x) {
        bool same = true;
        for (int c = 0; c < channels; ++c) same = same && samples(x, y, c) == transparent[c];
        EXPECT_EQ(picture(x, y).a, same ? 0 : 255);
      }
  }
}

class EncodePng : public ::testing::TestWithParam<unsigned> {};

TEST_P(EncodePng, ReadsBack) {
  const unsigned seed = GetParam();
  const Picture picture = picture_of(random_samples(1 + seed * 13 % 70, 1 + seed * 29 % 50, 3 + seed % 2, 8, seed));
  EXPECT_EQ(decoded(encode_png(picture)), picture);
  EXPECT_EQ(encode_png(picture), encode_png(Picture(picture)));
}
INSTANTIATE_TEST_SUITE_P(Seeds, EncodePng, ::testing::Range(0u, 8u));

TEST(EncodePng, NothingHasNoPng) { EXPECT_THROW(encode_png(Picture()), std::invalid_argument); }

TEST(WritePng, TheFileReadsBackWhateverItsName) {
  const TemporaryFolder folder;
  const Picture picture = smooth_picture(31, 17);
  write_png(folder / "drawing.jpg", picture);
  EXPECT_EQ(read_image(folder / "drawing.jpg"), picture);
}

TEST(Jpeg, GreyAndColourAreReadWithinTheCodecsError) {
  const Picture picture = opaque(smooth_picture(50, 40));
  for (const bool progressive : {false, true}) {
    EXPECT_LE(largest_difference(decoded(jpeg_file(samples_of(picture, 3), {.progressive = progressive})), picture), 6);
    Samples grey = samples_of(picture, 1);
    EXPECT_LE(largest_difference(decoded(jpeg_file(grey, {.progressive = progressive})), picture_of(grey)), 4);
  }
}

TEST(Jpeg, CmykIsLightTimesBlack) {
  Samples cmyk{40, 30, 4, 8, {}};
  Picture expected(40, 30);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) {
      const int c = 6 * x, m = 8 * y, k = 100;
      for (const int value : {c, m, 0, k}) cmyk.values.push_back(static_cast<std::uint16_t>(value));
      const auto light = [&](int ink) { return static_cast<std::uint8_t>((255 - ink) * (255 - k) / 255); };
      expected(x, y) = {light(c), light(m), light(0), 255};
    }
  EXPECT_LE(largest_difference(decoded(jpeg_file(cmyk, {.adobe = false})), expected), 6);
  Samples inverted = cmyk;
  for (auto& value : inverted.values) value = 255 - value;
  EXPECT_LE(largest_difference(decoded(jpeg_file(inverted, {.adobe = true})), expected), 6);
}

// Where the pixel (x, y) of the stored picture is to be seen.
std::pair<int, int> seen_at(int orientation, int x, int y, int width, int height) {
  const int u = width - 1 - x, v = height - 1 - y;
  const std::pair<int, int> places[] = {{x, y}, {x, y}, {u, y}, {u, v}, {x, v}, {y, x}, {v, x}, {v, u}, {y, u}};
  return places[orientation];
}

class OrientationTest : public ::testing::TestWithParam<int> {};

TEST_P(OrientationTest, IsHonoured) {
  const int orientation = GetParam();
  const Samples samples = samples_of(opaque(smooth_picture(37, 50)), 3);
  const Picture stored = decoded(jpeg_file(samples));
  for (const Picture& seen : {decoded(jpeg_file(samples, {.orientation = orientation})),
                              decoded(tiff_file(samples, {.orientation = orientation}))}) {
    ASSERT_EQ(seen.width, orientation > 4 ? 50 : 37);
    for (int y = 0; y < 50; ++y)
      for (int x = 0; x < 37; ++x) {
        const auto [u, v] = seen_at(orientation, x, y, 37, 50);
        EXPECT_NEAR(seen(u, v).r, stored(x, y).r, 4);
        EXPECT_NEAR(seen(u, v).g, stored(x, y).g, 4);
      }
  }
}
INSTANTIATE_TEST_SUITE_P(All, OrientationTest, ::testing::Range(1, 9));

class TiffTest : public ::testing::TestWithParam<Depth> {};

TEST_P(TiffTest, EverySampleIsRead) {
  const auto [channels, bits] = GetParam();
  const Samples samples = random_samples(37, 21, channels, bits, bits);
  TiffLook look;
  if (channels % 2 == 0) look.alpha = TiffLook::Alpha::straight;
  for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PACKBITS})
    for (const bool tiled : {false, true})
      for (const bool big_endian : {false, true}) {
        look.compression = compression;
        look.tiled = tiled;
        look.big_endian = look.big_tiff = big_endian;
        EXPECT_EQ(decoded(tiff_file(samples, look)), picture_of(samples))
            << "compression " << compression << (tiled ? " tiled" : "") << (big_endian ? " big-endian" : "");
      }
}
INSTANTIATE_TEST_SUITE_P(Depths, TiffTest,
                         ::testing::Values(Depth{1, 1}, Depth{1, 2}, Depth{1, 4}, Depth{1, 8}, Depth{1, 16},
                                           Depth{2, 8}, Depth{2, 16}, Depth{3, 8}, Depth{3, 16}, Depth{4, 8},
                                           Depth{4, 16}));

TEST(Tiff, ChannelsInPlanesAreTheSamePicture) {
  for (const int channels : {3, 4})
    for (const int bits : {8, 16}) {
      const Samples samples = random_samples(37, 21, channels, bits, bits);
      const auto alpha = channels == 4 ? TiffLook::Alpha::straight : TiffLook::Alpha::none;
      EXPECT_EQ(decoded(tiff_file(samples, {.alpha = alpha, .planes = true})), picture_of(samples));
    }
}

TEST(Tiff, AssociatedAlphaIsDividedOut) {
  const Picture straight = smooth_picture(40, 30);
  for (const int bits : {8, 16}) {
    Samples samples = samples_of(straight, 4);
    samples.bits = bits;
    for (std::size_t i = 0; i < samples.values.size(); i += 4) {
      const int a = samples.values[i + 3], scale = bits == 16 ? 257 : 1;
      for (std::size_t c = i; c < i + 3; ++c)
        samples.values[c] = static_cast<std::uint16_t>((samples.values[c] * a * scale + 127) / 255);
      samples.values[i + 3] = static_cast<std::uint16_t>(a * scale);
    }
    // The stored colours are rounded at 8 bits: an error of 1/2 grows by 255 / 55, the least alpha here.
    EXPECT_LE(largest_difference(decoded(tiff_file(samples, {.alpha = TiffLook::Alpha::associated})), straight), 3);
  }
}

TEST(Tiff, WhiteMayBeZero) {
  for (const int bits : {1, 4, 8, 16}) {
    Samples samples = random_samples(37, 21, 1, bits, bits);
    const Picture expected = picture_of(samples);
    for (auto& value : samples.values) value = static_cast<std::uint16_t>((1 << bits) - 1 - value);
    EXPECT_LE(largest_difference(decoded(tiff_file(samples, {.white_is_zero = true})), expected), 0) << bits;
  }
}

TEST(Tiff, PaletteColoursAreLookedUp) {
  const std::vector<Rgba> palette{{1, 2, 3}, {250, 0, 7}, {9, 99, 199}};
  for (const int bits : {1, 2, 4, 8}) {
    const Samples samples = random_samples(19, 11, 1, bits, bits);
    const Picture picture = decoded(tiff_file(samples, {.palette = palette}));
    for (int y = 0; y < 11; ++y)
      for (int x = 0; x < 19; ++x) EXPECT_EQ(picture(x, y), palette[samples(x, y, 0) % 3]);
  }
}

TEST(Webp, LosslessIsExactAndLossyIsNear) {
  Picture noise = picture_of(random_samples(33, 21, 4, 8, 1));
  for (Rgba& p : noise.pixels) p.a = std::max<std::uint8_t>(p.a, 1);  // the encoder clears the colour of alpha 0
  EXPECT_EQ(decoded(webp_file(noise, true)), noise);
  const Picture picture = smooth_picture(64, 48);
  EXPECT_LE(largest_difference(decoded(webp_file(picture, false, 95)), picture), 12);
  EXPECT_EQ(decoded(webp_file(opaque(picture), false))(3, 3).a, 255);
}

TEST(ReadImage, SixteenBitsGiveWhatEightBitsGive) {
  for (const int channels : {1, 2, 3, 4}) {
    const Samples eight = random_samples(23, 19, channels, 8, 5);
    Samples sixteen = eight;
    sixteen.bits = 16;
    for (auto& value : sixteen.values) value = static_cast<std::uint16_t>(value * 257);
    EXPECT_EQ(decoded(png_file(sixteen)), decoded(png_file(eight)));
    const auto alpha = channels % 2 ? TiffLook::Alpha::none : TiffLook::Alpha::straight;
    EXPECT_EQ(decoded(tiff_file(sixteen, {.alpha = alpha})), decoded(tiff_file(eight, {.alpha = alpha})));
  }
}

// ---- whatever is not a whole picture is refused
// ----------------------------------------------------------------------

TEST(ReadImage, SaysWhatIsWrong) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& name) {
    try {
      read_image(folder / name);
    } catch (const IoError& error) {
      EXPECT_EQ(error.side(), IoError::Side::input);
      return std::string(error.what());
    }
    return std::string("no error");
  };
  const auto write = [&](const std::string& name, const std::string& bytes) {
    write_file(folder / name, [&](std::ostream& out) { out << bytes; });
  };
  EXPECT_EQ(message("missing.png"), (folder / "missing.png").string() + ": no such file");
  EXPECT_THAT(message(""), HasSubstr("not a regular file"));
  write("empty.png", "");
  EXPECT_EQ(message("empty.png"), (folder / "empty.png").string() + ": empty file");
  write("text.png", "this is no picture\n");
  EXPECT_EQ(message("text.png"), (folder / "text.png").string() + ": not a PNG, JPEG, TIFF or WebP image");
}

TEST(ReadImage, AFileThatStopsEarlyIsRefusedWhereverItStops) {
  for (const auto& [name, bytes] : samples_of_all_formats(1)) {
    ASSERT_EQ(error_of(bytes), "no error") << name;
    const std::size_t step = std::max<std::size_t>(1, bytes.size() / 400);
    for (std::size_t size = 0; size < bytes.size(); size += size + 40 < bytes.size() ? step : 1) {
      const std::string error = error_of(bytes.substr(0, size));
      EXPECT_THAT(error, AllOf(HasSubstr("a: "), Not(HasSubstr("\n")))) << name << " cut at " << size;
      // Everything behind the first bytes is called what it is.
      if (size > 200) {
        EXPECT_THAT(error, HasSubstr("truncated")) << name << " cut at " << size;
      }
    }
  }
}

TEST(ReadImage, DamagedBytesNeverCrashNorPrint) {
  const TemporaryFolder folder;
  const ErrorStream errors(folder / "stderr");
  int refused = 0, read = 0;
  for (unsigned seed = 0; seed < 1000; ++seed) {
    std::mt19937 random(seed);
    const auto all = samples_of_all_formats(seed % 4);
    std::string bytes = all[seed % all.size()].second;
    for (unsigned i = 0; i <= random() % 8; ++i) {
      const std::size_t where =
          random() % 2 ? random() % bytes.size() : random() % std::min<std::size_t>(bytes.size(), 60);
      bytes[where] = static_cast<char>(random());
    }
    try {
      const Picture picture = decoded(bytes);
      EXPECT_EQ(picture.pixels.size(), static_cast<std::size_t>(picture.width) * picture.height);
      ++read;
    } catch (const IoError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      ++refused;
    }
  }
  EXPECT_EQ(errors.text(), "");
  EXPECT_GT(refused, 100);
  EXPECT_GT(read, 0);
}

TEST(ReadImage, AnAlphaWithoutItsChannelIsNoneToRead) {
  std::string bytes = tiff_file(random_samples(37, 21, 2, 8, 1), {.alpha = TiffLook::Alpha::straight, .tiled = true});
  const std::string samples_per_pixel("\x15\x01\x03\0\x01\0\0\0\x02", 9);
  const std::size_t tag = bytes.find(samples_per_pixel);
  ASSERT_NE(tag, std::string::npos);
  bytes[tag + 8] = 1;
  try {
    EXPECT_EQ(decoded(bytes).width, 37);
  } catch (const IoError&) {
  }
}

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
  return bytes;
}

TEST(ReadImage, TooLargeAPictureIsRefusedByItsHeader) {
  std::string png = png_file(random_samples(9, 9, 3, 8, 1));
  EXPECT_EQ(error_of(std::string(png).replace(16, 4, big_endian(100000))),
            "a: width must be in [1, 16384], got 100000");
  EXPECT_EQ(error_of(std::string(png).replace(20, 4, big_endian(16385))), "a: height must be in [1, 16384], got 16385");
  EXPECT_EQ(error_of(std::string(png).replace(20, 4, big_endian(0))), "a: height must be in [1, 16384], got 0");

  std::string jpeg = jpeg_file(random_samples(9, 9, 3, 8, 1));
  const std::size_t frame = jpeg.find("\xff\xc0");
  EXPECT_EQ(error_of(std::string(jpeg).replace(frame + 5, 4, "\xfd\xe8\xfd\xe9")),
            "a: width must be in [1, 16384], got 65001");

  std::string tiff = tiff_file(Samples{20000, 1, 1, 1, std::vector<std::uint16_t>(20000)});
  EXPECT_EQ(error_of(tiff), "a: width must be in [1, 16384], got 20000");
}

TEST(ReadImage, ALegalHeaderWithoutThePixelsIsTruncated) {
  std::string png = png_file(random_samples(9, 9, 3, 8, 1));
  const std::string largest = big_endian(kLargestSide) + big_endian(kLargestSide);
  EXPECT_EQ(error_of(std::string(png).replace(16, 8, largest)), "a: truncated PNG image");

  std::string jpeg = jpeg_file(random_samples(9, 9, 3, 8, 1));
  const std::size_t frame = jpeg.find("\xff\xc0");
  EXPECT_EQ(error_of(std::string(jpeg).replace(frame + 5, 4, std::string("\x40\0\x40\0", 4))),
            "a: truncated JPEG image");
}

TEST(ReadImage, TheLargestLegalSideIsRead) {
  Samples line{kLargestSide, 1, 1, 8, std::vector<std::uint16_t>(kLargestSide, 77)};
  EXPECT_EQ(decoded(png_file(line)).width, kLargestSide);
  EXPECT_EQ(decoded(tiff_file(line)).width, kLargestSide);
}

}  // namespace
}  // namespace carve
