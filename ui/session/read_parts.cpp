#include "ui/session/read_parts.h"

#include <algorithm>
#include <set>

#include "core/geometry/diagnosis.h"
#include "core/geometry/triangles.h"

namespace lamella::ui {
namespace {

/// mm of the unit that parts of this size, read in mm, are likely in.
double unit_of_size(const std::vector<Part>& parts) {
  std::vector<Vec<3>> points;
  for (const Part& part : parts)
    points.insert(points.end(), part.surface.points.begin(), part.surface.points.end());
  if (points.empty()) return 1;
  const std::string guess = guess_unit(diagonal_of(points));
  return guess == "inch" ? 25.4 : guess == "m" ? 1000 : 1;
}

}  // namespace

bool names_stl(const std::filesystem::path& file) {
  const QString ending = QString::fromStdString(file.extension().string());
  return ending.compare(".stl", Qt::CaseInsensitive) == 0;
}

Result<ReadParts> read_parts(const Services& services,
                             const std::vector<std::filesystem::path>& files,
                             std::vector<double>& units, const LoadParams& params,
                             const Progress& progress) {
  ReadParts read;
  const double share = 1.0 / static_cast<double>(std::max<std::size_t>(1, files.size()));
  for (std::size_t k = 0; k < files.size(); ++k) {
    const auto at = static_cast<double>(k);
    LoadParams own = params;
    const auto load = [&](double unit) {
      own.unit = unit;
      return services.load_parts(files[k], own, progress.portion(share * at, share * (at + 1)));
    };
    auto loaded = load(units[k] > 0 ? units[k] : 1);
    if (loaded && units[k] == 0) {
      units[k] = unit_of_size(*loaded);
      if (units[k] != 1) loaded = load(units[k]);
    }
    if (!loaded) return loaded.error();
    for (std::size_t p = 0; p < loaded->size(); ++p) {
      read.parts.push_back(std::move((*loaded)[p]));
      read.sources.push_back({files[k], p, units[k]});
    }
  }
  return read;
}

void name_parts(ReadParts& read, std::size_t first, const std::vector<std::string>& left_out,
                bool drop_left_out) {
  std::set<std::string> taken;
  if (!drop_left_out) taken.insert(left_out.begin(), left_out.end());
  number_names(read.parts, first, std::move(taken));
  if (!drop_left_out) return;
  for (std::size_t k = read.parts.size(); k-- > first;) {
    if (std::find(left_out.begin(), left_out.end(), read.parts[k].name) == left_out.end()) continue;
    read.parts.erase(read.parts.begin() + static_cast<std::ptrdiff_t>(k));
    read.sources.erase(read.sources.begin() + static_cast<std::ptrdiff_t>(k));
  }
}

Result<std::vector<Part>> read_again(const Services& services, const std::vector<Part>& parts,
                                     const std::vector<PartSource>& sources,
                                     const LoadParams& params, const Progress& progress) {
  std::vector<Part> all = parts;
  std::vector<Part> file;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (k == 0 || sources[k].file != sources[k - 1].file ||
        sources[k].unit != sources[k - 1].unit) {
      LoadParams own = params;
      own.unit = sources[k].unit;
      const auto count = static_cast<double>(all.size());
      auto loaded = services.load_parts(
          sources[k].file, own,
          progress.portion(static_cast<double>(k) / count, static_cast<double>(k + 1) / count));
      if (!loaded) return loaded.error();
      file = std::move(*loaded);
    }
    if (sources[k].index >= file.size())
      return Error{Code::bad_input,
                   "\"" + sources[k].file.string() + "\" has changed since it was opened.",
                   "Open it again."};
    Part part = file[sources[k].index];
    part.name = all[k].name;
    all[k] = std::move(part);
  }
  return all;
}

}  // namespace lamella::ui
