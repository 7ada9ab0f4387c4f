#include <png.h>

#include <csetjmp>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <vector>

#include "renderer/core/atomic_file.h"
#include "renderer/core/input_file.h"
#include "renderer/film/image_io.h"

// libpng reports errors by longjmp(), which must not skip a destructor. So every call into libpng stands in one of the
// functions marked "jump", which own nothing: no local of theirs or of a callback has a destructor, and no local
// changes after setjmp. Everything that owns memory lives in their callers.

namespace brume {
namespace {

/// What libpng's callbacks see.
struct Context {
  char reason[200] = "";
  std::ifstream* input = nullptr;
  std::string* output = nullptr;
};

extern "C" {

void on_png_error(png_structp png, png_const_charp message) {
  auto* context = static_cast<Context*>(png_get_error_ptr(png));
  std::strncpy(context->reason, message, sizeof context->reason - 1);
  png_longjmp(png, 1);
}

void on_png_warning(png_structp, png_const_charp) {}

void read_bytes(png_structp png, png_bytep data, png_size_t size) {
  std::ifstream* input = static_cast<Context*>(png_get_io_ptr(png))->input;
  if (!input->read(reinterpret_cast<char*>(data), static_cast<std::streamsize>(size)))
    png_error(png, "it ends too early");
}

void write_bytes(png_structp png, png_bytep data, png_size_t size) {
  bool appended = true;
  try {
    static_cast<Context*>(png_get_io_ptr(png))->output->append(reinterpret_cast<const char*>(data), size);
  } catch (...) {
    appended = false;
  }
  if (!appended) png_error(png, "out of memory");
}

void flush_bytes(png_structp) {}

}  // extern "C"

/// Owns libpng's two structs for reading.
struct Reader {
  png_structp png = nullptr;
  png_infop info = nullptr;

  explicit Reader(Context& context)
      : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &context, on_png_error, on_png_warning)),
        info(png ? png_create_info_struct(png) : nullptr) {}
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

struct Writer {
  png_structp png = nullptr;
  png_infop info = nullptr;

  explicit Writer(Context& context)
      : png(png_create_write_struct(PNG_LIBPNG_VER_STRING, &context, on_png_error, on_png_warning)),
        info(png ? png_create_info_struct(png) : nullptr) {}
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { png_destroy_write_struct(&png, &info); }
};

/// Jump. Everything before the pixels; sets the conversions to RGB8 or RGBA8.
bool read_header(png_structp png, png_infop info, Context* context) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_read_fn(png, context, read_bytes);
  // A wrong checksum is an error in every chunk: otherwise a damaged scene would silently be missing.
  png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
  constexpr png_uint_32 kMaxSide = 1u << 24;  // below the limit on pixels; keeps row sizes far from overflow
  png_set_user_limits(png, kMaxSide, kMaxSide);
  constexpr png_alloc_size_t kMaxChunk = png_alloc_size_t{256} << 20;  // scenes may be long, memory is not endless
  png_set_chunk_malloc_max(png, kMaxChunk);
  png_read_info(png, info);
  png_set_expand(png);  // palette, 1 to 4 bits, transparent colours
  png_set_scale_16(png);
  png_set_gray_to_rgb(png);
  return true;
}

/// Jump. Interlaced files need several passes over the rows, and that is told before the layout is final.
bool read_rows(png_structp png, png_infop info, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_read_image(png, rows);
  png_read_end(png, info);
  return true;
}

/// Jump.
bool settle_layout(png_structp png, png_infop info) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  return true;
}

/// Jump.
bool write_all(png_structp png, png_infop info, Context* context, const Image8* image, png_textp texts, int text_count,
               png_bytepp rows) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_write_fn(png, context, write_bytes, flush_bytes);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image->width), static_cast<png_uint_32>(image->height), 8,
               image->channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_text(png, info, texts, text_count);
  png_write_info(png, info);
  png_write_image(png, rows);
  png_write_end(png, nullptr);
  return true;
}

/// One pointer for each row, as libpng wants it.
std::vector<png_bytep> row_pointers(std::uint8_t* bytes, std::size_t height, std::size_t row_size) {
  std::vector<png_bytep> rows(height);
  for (std::size_t y = 0; y < height; ++y) rows[y] = bytes + y * row_size;
  return rows;
}

Error damaged(const std::string& path, const Context& context) {
  return file_error(path, "this PNG file is damaged or truncated: " + quoted_reason(context.reason));
}

/// Every chunk up to the last one lies within the file. libpng takes, and clears, as much memory as a damaged length
/// says: 20 s for 2 GB.
bool chunk_lengths_fit(std::ifstream& file, std::uintmax_t file_size) {
  constexpr std::uintmax_t kSignatureSize = 8, kFrameSize = 12;  // of a chunk: length, type, checksum
  std::uintmax_t position = kSignatureSize;
  for (std::string type; type != "IEND";) {
    unsigned char start[8] = {};
    file.seekg(static_cast<std::streamoff>(position));
    if (!file.read(reinterpret_cast<char*>(start), sizeof start)) return false;
    type.assign(start + 4, start + 8);
    position += kFrameSize + (std::uintmax_t{start[0]} << 24 | start[1] << 16 | start[2] << 8 | start[3]);
    if (position > file_size) return false;
  }
  file.seekg(0);
  return file.good();
}

Result<Image8File> decode(const std::string& path) {
  std::ifstream input(path, std::ios::binary);
  if (!chunk_lengths_fit(input, std::filesystem::file_size(path)))
    return file_error(path, "this PNG file is damaged or truncated: it ends too early");
  Context context;
  context.input = &input;
  Reader reader(context);
  if (!reader.info) return file_error(path, "cannot start libpng", ErrorCode::Internal);
  if (!read_header(reader.png, reader.info, &context)) return damaged(path, context);

  const std::int64_t width = png_get_image_width(reader.png, reader.info);
  const std::int64_t height = png_get_image_height(reader.png, reader.info);
  if (width > kMaxImagePixels / height)
    return file_error(path, "found " + std::to_string(width) + " x " + std::to_string(height) +
                                " pixels, expected at most " + std::to_string(kMaxImagePixels) + " in total");
  if (!settle_layout(reader.png, reader.info)) return damaged(path, context);

  const int channels = png_get_channels(reader.png, reader.info);
  Image8File result;
  result.image = Image8(static_cast<int>(width), static_cast<int>(height), channels);
  if (png_get_rowbytes(reader.png, reader.info) != static_cast<std::size_t>(width * channels) ||
      !is_consistent(result.image))
    return file_error(path, "libpng offers a row of unexpected size", ErrorCode::Internal);
  std::vector<png_bytep> rows = row_pointers(result.image.bytes.data(), static_cast<std::size_t>(height),
                                             static_cast<std::size_t>(width * channels));
  if (!read_rows(reader.png, reader.info, rows.data())) return damaged(path, context);

  png_textp texts = nullptr;
  const int text_count = png_get_text(reader.png, reader.info, &texts, nullptr);
  for (int i = 0; i < text_count; ++i) detail::add_entry(result.metadata, texts[i].key, texts[i].text);
  return result;
}

Result<std::string> encode(const Image8& image, const ImageMetadata& metadata, const std::string& path) {
  const std::map<std::string, std::string> entries = detail::to_entries(metadata);
  std::vector<png_text> texts;
  char no_language[] = "";
  for (const auto& [name, text] : entries) {
    png_text entry{};
    entry.compression = PNG_ITXT_COMPRESSION_zTXt;
    // libpng copies both and changes neither.
    entry.key = const_cast<char*>(name.c_str());
    entry.text = const_cast<char*>(text.c_str());
    entry.lang = no_language;
    entry.lang_key = no_language;
    texts.push_back(entry);
  }
  // png_write_image() takes rows it does not change by a pointer that could.
  std::vector<png_bytep> rows =
      row_pointers(const_cast<std::uint8_t*>(image.bytes.data()), static_cast<std::size_t>(image.height),
                   static_cast<std::size_t>(image.width) * image.channels);

  std::string bytes;
  Context context;
  context.output = &bytes;
  Writer writer(context);
  if (!writer.info ||
      !write_all(writer.png, writer.info, &context, &image, texts.data(), static_cast<int>(texts.size()), rows.data()))
    return file_error(path, "cannot encode as PNG: " + quoted_reason(context.reason), ErrorCode::Internal);
  return bytes;
}

}  // namespace

Result<void> write_png(const std::string& path, const Image8& image, const ImageMetadata& metadata) {
  if (image.empty() || !is_consistent(image))
    return file_error(path, "found an image without pixels, expected at least one");
  if (Result<void> checked = detail::check_metadata(path, metadata); !checked) return checked;
  try {
    const Result<std::string> bytes = encode(image, metadata, path);
    if (!bytes) return bytes.error();
    return write_text_atomically(path, *bytes);
  } catch (const std::exception& exception) {
    return file_error(path, "cannot encode as PNG: " + quoted_reason(exception.what()), ErrorCode::Internal);
  }
}

Result<Image8File> read_png(const std::string& path) {
  if (const Result<void> readable = check_readable(path); !readable) return readable.error();
  if (!begins_with(path, "\x89PNG\r\n\x1a\n"))
    return file_error(path, "found another kind of file, expected a PNG image");
  try {
    return decode(path);
  } catch (const std::exception& exception) {
    return file_error(path, "cannot read this PNG file: " + quoted_reason(exception.what()));
  }
}

}  // namespace brume
