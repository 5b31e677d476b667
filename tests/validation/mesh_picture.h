#pragma once

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "core/mesh/simplex_mesh.h"
#include "core/study/svg_plot.h"

/// Pictures of plane meshes for the pages.
namespace lamella {

/// What one panel shows: the part of a mesh in a window, with a caption below.
struct MeshPanel {
  const SimplexMesh<2>* mesh;
  Vec<2> low, high;  ///< the window, mm
  std::string caption;
};

/// Panels side by side, at one width, as the text of an SVG file.
inline std::string mesh_picture(const std::vector<MeshPanel>& panels, const std::string& title) {
  constexpr double kWidth = 300, kGap = 16, kCaption = 26;
  const auto number = [](double v) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f", v);
    return std::string(text);
  };
  const auto attribute = [&](const char* name, double v) {
    return " " + std::string(name) + "=\"" + number(v) + "\"";
  };
  double tallest = 0;
  for (const MeshPanel& p : panels)
    tallest = std::max(tallest, kWidth * (p.high[1] - p.low[1]) / (p.high[0] - p.low[0]));
  const double width = (kWidth + kGap) * static_cast<double>(panels.size()) + kGap;
  const double height = tallest + kGap + kCaption;
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + number(width) +
                    " " + number(height) + "\"" + attribute("width", width) +
                    attribute("height", height) + ">\n<title>" + escaped(title) +
                    "</title>\n<style>text{font:12px sans-serif;fill:#1c2733}"
                    "path{stroke-linejoin:round}"
                    ".in{fill:#e4eff4;stroke:#0f6b8f;stroke-width:.5}"
                    ".rim{fill:none;stroke:#1c2733;stroke-width:1.2}</style>\n"
                    "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  double left = kGap;
  for (const MeshPanel& panel : panels) {
    const double scale = kWidth / (panel.high[0] - panel.low[0]);
    const double tall = scale * (panel.high[1] - panel.low[1]);
    const auto at = [&](const Vec<2>& p) {
      return number(scale * (p[0] - panel.low[0])) + " " + number(scale * (panel.high[1] - p[1]));
    };
    const auto seen = [&](const auto& corners) {
      Vec<2> low = corners[0], high = corners[0];
      for (const Vec<2>& p : corners) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
      return (low.array() < panel.high.array()).all() && (high.array() > panel.low.array()).all();
    };
    svg += "<svg" + attribute("x", left) + attribute("y", kGap / 2 + (tallest - tall) / 2) +
           attribute("width", kWidth) + attribute("height", tall) + "><path class=\"in\" d=\"";
    for (const auto& e : panel.mesh->elements) {
      const auto p = panel.mesh->corners(e);
      if (seen(p)) svg += "M" + at(p[0]) + "L" + at(p[1]) + "L" + at(p[2]) + "Z";
    }
    svg += "\"/><path class=\"rim\" d=\"";
    for (const auto& f : panel.mesh->facets) {
      const auto p = panel.mesh->corners(f);
      if (seen(p)) svg += "M" + at(p[0]) + "L" + at(p[1]);
    }
    svg += "\"/></svg>\n<text text-anchor=\"middle\"" + attribute("x", left + kWidth / 2) +
           attribute("y", height - 10) + ">" + escaped(panel.caption) + "</text>\n";
    left += kWidth + kGap;
  }
  return svg + "</svg>\n";
}

}  // namespace lamella
