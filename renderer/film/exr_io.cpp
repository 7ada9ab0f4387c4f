#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfCompression.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "renderer/core/atomic_file.h"
#include "renderer/core/input_file.h"
#include "renderer/film/image_io.h"

namespace brume {
namespace {

constexpr int kNoThreads = 0;  // OpenEXR's thread pool is global; the caller's thread does the work

/// Where the float `component` of the pixel with OpenEXR's coordinates (x, y) lies. OpenEXR wants the address of
/// pixel (0, 0), which lies outside the storage when the data window begins elsewhere: computed as an integer, since
/// such a pointer is not allowed in C++.
Imf::Slice float_slice(const Image& image, const float Color::*component, Imath::V2i first_pixel) {
  const std::intptr_t x_stride = sizeof(Color), y_stride = x_stride * image.width;
  const std::intptr_t first = reinterpret_cast<std::intptr_t>(&(image.pixels.front().*component));
  const std::intptr_t base = first - first_pixel.x * x_stride - first_pixel.y * y_stride;
  return Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(base), static_cast<std::size_t>(x_stride),
                    static_cast<std::size_t>(y_stride));
}

/// The whole file as bytes. In memory first: OpenEXR writes its table of offsets in a destructor, where a full disk
/// would go unnoticed.
std::string encode(const Image& image, const ImageMetadata& metadata) {
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer frame;
  constexpr std::pair<const char*, float Color::*> kChannels[] = {{"R", &Color::r}, {"G", &Color::g}, {"B", &Color::b}};
  for (const auto& [name, component] : kChannels) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    frame.insert(name, float_slice(image, component, {0, 0}));
  }
  // ITU-R BT.709-6, item 1.4 and 1.5.
  const Imf::Chromaticities rec709({0.64f, 0.33f}, {0.30f, 0.60f}, {0.15f, 0.06f}, {0.3127f, 0.3290f});
  header.insert("chromaticities", Imf::ChromaticitiesAttribute(rec709));
  for (const auto& [name, text] : detail::to_entries(metadata)) header.insert(name, Imf::StringAttribute(text));

  Imf::StdOSStream stream;
  {
    Imf::OutputFile file(stream, header, kNoThreads);
    file.setFrameBuffer(frame);
    file.writePixels(image.height);
  }
  return stream.str();
}

std::string names(const Imf::ChannelList& channels) {
  std::string text;
  for (auto channel = channels.begin(); channel != channels.end(); ++channel)
    text += (text.empty() ? "" : ", ") + std::string(channel.name());
  return text.empty() ? "none" : quoted_reason(text);
}

/// Which channels of the file become which components of a pixel. Grey is read into red, and copied afterwards: a frame
/// buffer has one place for each name.
using Layout = std::vector<std::pair<std::string, float Color::*>>;

Result<Layout> choose_channels(const Imf::ChannelList& channels, const std::string& path) {
  Layout layout{{"Y", &Color::r}};
  const bool chroma = channels.findChannel("RY") || channels.findChannel("BY");
  if (channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B"))
    layout = {{"R", &Color::r}, {"G", &Color::g}, {"B", &Color::b}};
  else if (!channels.findChannel("Y") || chroma)
    return file_error(path, "found the channels " + names(channels) + ", expected R, G, B or Y alone");

  for (const auto& [name, component] : layout) {
    const Imf::Channel& channel = channels[name];
    if (channel.type != Imf::HALF && channel.type != Imf::FLOAT)
      return file_error(path, "found whole numbers in channel " + name + ", expected 16- or 32-bit floats");
    if (channel.xSampling != 1 || channel.ySampling != 1)
      return file_error(path, "found fewer samples than pixels in channel " + name + ", expected one per pixel");
  }
  return layout;
}

/// Fills `image` with the lines from image_top on, in OpenEXR's coordinates.
void read_lines(Imf::InputFile& file, const Layout& layout, int image_left, int image_top, Image& image) {
  Imf::FrameBuffer frame;
  for (const auto& [name, component] : layout)
    frame.insert(name, float_slice(image, component, {image_left, image_top}));
  file.setFrameBuffer(frame);
  file.readPixels(image_top, image_top + image.height - 1);
}

/// Every attribute of the header lies within the file. OpenEXR believes a damaged length: it takes that much memory,
/// and for text of 1 GB some 17 s, before it notices that the file has ended.
bool attribute_lengths_fit(std::ifstream& stream, std::uintmax_t file_size) {
  constexpr std::uint32_t kMultiPart = 0x1000;  // then one more empty name ends the list of headers
  std::uint32_t magic = 0, version = 0;
  const auto read_word = [&](std::uint32_t& word) { stream.read(reinterpret_cast<char*>(&word), sizeof word); };
  read_word(magic);
  read_word(version);
  const int last_empty_name = version & kMultiPart ? 2 : 1;
  std::string name, type;
  for (int empty_names = 0; empty_names < last_empty_name;) {
    if (!std::getline(stream, name, '\0')) return false;
    if (name.empty()) {
      ++empty_names;
      continue;
    }
    empty_names = 0;
    std::uint32_t length = 0;
    std::getline(stream, type, '\0');
    read_word(length);
    const std::streamoff position = stream.tellg();
    if (position < 0 || length > file_size - static_cast<std::uintmax_t>(position)) return false;
    stream.seekg(length, std::ios::cur);
  }
  stream.seekg(0);
  return stream.good();
}

/// Deflate shrinks data at most 1032 times (RFC 1951: 258 bytes in 2 bits), run lengths even less; the other
/// compressions have no such limit. OpenEXR fills what a block lacks with whatever was in memory, so it would not
/// notice.
bool size_is_plausible(Imf::Compression compression, std::int64_t pixels, std::uintmax_t file_size) {
  const bool limited = compression == Imf::NO_COMPRESSION || compression == Imf::RLE_COMPRESSION ||
                       compression == Imf::ZIPS_COMPRESSION || compression == Imf::ZIP_COMPRESSION;
  constexpr std::uintmax_t kMaxRatio = 1032, kBytesPerPixel = 2;  // one channel of halves
  return !limited || static_cast<std::uintmax_t>(pixels) * kBytesPerPixel / kMaxRatio <= file_size;
}

/// Throws what OpenEXR throws.
Result<ImageFile> decode(std::ifstream& stream, std::uintmax_t file_size, const std::string& path) {
  Imf::StdIFStream input(stream, "file");  // messages name it; the path is in the error's source
  Imf::InputFile file(input, kNoThreads);
  const Imf::Header& header = file.header();
  const Imath::Box2i window = header.dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  if (width < 1 || height < 1 || width > kMaxImagePixels / height)
    return file_error(path, "found " + std::to_string(width) + " x " + std::to_string(height) +
                                " pixels, expected 1 to " + std::to_string(kMaxImagePixels) + " in total");
  if (!size_is_plausible(header.compression(), width * height, file_size))
    return file_error(path, "this OpenEXR file is damaged: found " + std::to_string(width) + " x " +
                                std::to_string(height) + " pixels, more than it can hold");
  const Result<Layout> layout = choose_channels(header.channels(), path);
  if (!layout) return layout.error();

  // A damaged size shows in the first or the last line, before memory for all the others is taken.
  Image line(static_cast<int>(width), 1);
  read_lines(file, *layout, window.min.x, window.min.y, line);
  read_lines(file, *layout, window.min.x, window.max.y, line);

  ImageFile result;
  result.image = Image(static_cast<int>(width), static_cast<int>(height));
  read_lines(file, *layout, window.min.x, window.min.y, result.image);
  const bool grey = layout->size() == 1;
  if (grey)
    for (Color& pixel : result.image.pixels) pixel = Color(pixel.r);

  for (auto attribute = header.begin(); attribute != header.end(); ++attribute)
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute()))
      detail::add_entry(result.metadata, attribute.name(), text->value());
  return result;
}

}  // namespace

Result<void> write_exr(const std::string& path, const Image& image, const ImageMetadata& metadata) {
  if (image.empty() || !is_consistent(image))
    return file_error(path, "found an image without pixels, expected at least one");
  if (Result<void> checked = detail::check_metadata(path, metadata); !checked) return checked;
  std::string bytes;
  try {
    bytes = encode(image, metadata);
  } catch (const std::exception& exception) {
    return file_error(path, "cannot encode as OpenEXR: " + quoted_reason(exception.what()), ErrorCode::Internal);
  }
  return write_text_atomically(path, bytes);
}

Result<ImageFile> read_exr(const std::string& path) {
  if (const Result<void> readable = check_readable(path); !readable) return readable.error();
  if (!begins_with(path, "\x76\x2f\x31\x01"))
    return file_error(path, "found another kind of file, expected an OpenEXR image");
  try {
    std::ifstream stream(path, std::ios::binary);
    const std::uintmax_t file_size = std::filesystem::file_size(path);
    if (!attribute_lengths_fit(stream, file_size))
      return file_error(path, "this OpenEXR file is damaged or truncated: its header goes on beyond its end");
    return decode(stream, file_size, path);
  } catch (const std::exception& exception) {
    return file_error(
        path, "this OpenEXR file is damaged, truncated or of an unknown kind: " + quoted_reason(exception.what()));
  } catch (...) {
    return file_error(path, "this OpenEXR file is damaged: unknown exception");
  }
}

}  // namespace brume
