// Picture files that carry the scene they were made from.
#pragma once

#include <map>
#include <string>

#include "renderer/core/error.h"
#include "renderer/film/image.h"

namespace brume {

/// Text stored inside a picture file, UTF-8 without zero bytes.
struct ImageMetadata {
  std::string scene_json;                    ///< under "brume:scene"; empty when there is none
  std::map<std::string, std::string> extra;  ///< each under "brume:<key>", e.g. {"samples", "64"}; see below for keys

  bool operator==(const ImageMetadata&) const = default;
};

// A key of `extra` has 1 to 64 printable ASCII characters, no blanks, and is not "scene": what both formats can hold.

struct ImageFile {
  Image image;
  ImageMetadata metadata;
};

struct Image8File {
  Image8 image;
  ImageMetadata metadata;
};

// All functions: paths are UTF-8 as the user typed them. Errors are one sentence with the path as their source. Any
// thread, also several at the same time on different files. Writers leave an existing file untouched until the new one
// is complete (core/atomic_file.h); they refuse an image without pixels or with storage of the wrong size.

/// OpenEXR: one part of scanlines, 32-bit float R, G, B, ZIP (lossless), chromaticities of Rec. 709 with white D65;
/// metadata in string attributes. Every bit of every float survives, NaN and infinity too.
Result<void> write_exr(const std::string& path, const Image& image, const ImageMetadata& metadata = {});

/// Reads channels R, G, B, or Y alone as grey, of 16- or 32-bit floats, scanlines or tiles, any lossless or lossy
/// compression; other channels are ignored, of several parts the first one is read. The image is the data window
/// (pixel (0, 0) is its upper left corner), whatever the display window says. Values are taken as Rec. 709.
/// Errors: no such file, no permission, not an OpenEXR file, no RGB or Y (the message lists what there is),
/// whole-number or subsampled channels, deep pixels, more than kMaxImagePixels, truncated or damaged.
Result<ImageFile> read_exr(const std::string& path);

/// PNG of 8 bits per channel, RGB or RGBA by image.channels, marked as sRGB with perceptual intent; metadata in
/// compressed iTXt chunks.
Result<void> write_png(const std::string& path, const Image8& image, const ImageMetadata& metadata = {});

/// Reads any PNG as RGB8 or, where it has transparency, RGBA8: grey, palette and 16-bit files are converted; a gamma
/// other than sRGB's is not applied.
/// Errors: no such file, no permission, not a PNG file, more than kMaxImagePixels, truncated or damaged.
Result<Image8File> read_png(const std::string& path);

namespace detail {

/// What the writers ask of metadata before they begin.
Result<void> check_metadata(const std::string& path, const ImageMetadata& metadata);
/// All entries by their full names: "brume:scene", "brume:<key>".
std::map<std::string, std::string> to_entries(const ImageMetadata& metadata);
/// Takes one entry of a file; names without "brume:" belong to somebody else and are ignored.
void add_entry(ImageMetadata& metadata, const std::string& name, const std::string& text);

}  // namespace detail
}  // namespace brume
