// SPDX-License-Identifier: BSD-3-Clause
// A navigation grid as a map of ROS's map_server.
#include <csom/core/Error.h>
#include <csom/exports/NavigationFiles.h>
#include <csom/io/OutputFile.h>
#include <png.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace csom {
namespace {

using Pixels = std::vector<std::uint8_t>;

/// One byte a cell, rows from high y to low y.
template <class ValueOf>
Pixels pixelsOf(const NavigationGrid& grid, ValueOf&& value_of) {
  Pixels pixels;
  pixels.reserve(static_cast<std::size_t>(grid.width()) * static_cast<std::size_t>(grid.height()));
  for (int y = grid.height() - 1; y >= 0; --y)
    for (int x = 0; x < grid.width(); ++x)
      pixels.push_back(static_cast<std::uint8_t>(value_of(x, y)));
  return pixels;
}

std::string shortest(double value) {
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

void writeImage(const NavigationGrid& grid, OutputFile& out) {
  // What map_server writes itself. With the thresholds below, 205 reads back as unknown.
  const Pixels pixels = pixelsOf(grid, [&](int x, int y) {
    switch (grid.state(x, y)) {
      case NavigationGrid::State::Free:
        return 254;
      case NavigationGrid::State::Occupied:
        return 0;
      case NavigationGrid::State::Unknown:
        break;
    }
    return 205;
  });
  out.write("P5\n" + std::to_string(grid.width()) + " " + std::to_string(grid.height()) +
            "\n255\n");
  out.write(pixels.data(), pixels.size());
}

void writeYaml(const NavigationGrid& grid, const std::string& image, OutputFile& out) {
  std::string quoted;
  for (const char c : image) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  const Eigen::Vector2d origin = grid.origin();
  out.write("image: '" + quoted + "'\nmode: trinary\nresolution: " + shortest(grid.resolution()) +
            "\norigin: [" + shortest(origin.x()) + ", " + shortest(origin.y()) +
            ", 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

void writeClasses(const NavigationGrid& grid, const LabelSet& labels, const std::string& file,
                  OutputFile& out) {
  const int unknown = labels.numberOfClasses();
  if (unknown >= kMaxClasses)
    throw ConfigError(
        "a palette has 256 colours, one of them for unknown; a map of 256 classes "
        "cannot be exported as an image of classes");
  Pixels palette;
  for (const LabelClass& c : labels.classes())
    palette.insert(palette.end(), {c.color[0], c.color[1], c.color[2], 255});
  palette.insert(palette.end(), {0, 0, 0, 0});
  const Pixels pixels =
      pixelsOf(grid, [&](int x, int y) -> int { return grid.classAt(x, y).value_or(unknown); });

  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(grid.width());
  image.height = static_cast<png_uint_32>(grid.height());
  image.format = PNG_FORMAT_RGBA_COLORMAP;
  image.colormap_entries = static_cast<png_uint_32>(unknown + 1);
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  Pixels bytes(size);
  constexpr int kAsItIs = 0;
  constexpr int kPackedRows = 0;
  if (png_image_write_to_memory(&image, bytes.data(), &size, kAsItIs, pixels.data(), kPackedRows,
                                palette.data()) == 0)
    throw FileError(file, std::string("cannot be written: ") + image.message);
  out.write(bytes.data(), size);
}

}  // namespace

NavigationFiles NavigationFiles::named(const std::string& yaml) {
  const std::filesystem::path path(yaml);
  if (path.extension() != ".yaml" || path.stem().empty())
    throw ConfigError(yaml + ": name the file .yaml; a .pgm and a .png stand beside it");
  const std::string stem = (path.parent_path() / path.stem()).string();
  return {yaml, stem + ".pgm", stem + "_classes.png"};
}

void writeNavigationFiles(const NavigationGrid& grid, const LabelSet& labels,
                          const NavigationFiles& files) {
  OutputFile image(files.image);
  OutputFile classes(files.classes);
  OutputFile yaml(files.yaml);
  writeImage(grid, image);
  writeClasses(grid, labels, files.classes, classes);
  writeYaml(grid, std::filesystem::path(files.image).filename().string(), yaml);
  // The YAML file last: who finds it finds the images, too.
  image.commit();
  try {
    classes.commit();
    yaml.commit();
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(files.image, ignored);
    std::filesystem::remove(files.classes, ignored);
    throw;
  }
}

}  // namespace csom
