#include <algorithm>
#include <cmath>

#include "core/base/version.h"
#include "core/study/report.h"

namespace lamella {

namespace {

const char* const kStyle = R"(
:root{--ink:#1d2733;--soft:#5b6875;--line:#dfe4e9;--accent:#0f6b8f;--good:#2c7a4b;--warn:#b45f06;--bad:#b3261e}
*{box-sizing:border-box}
body{margin:0;background:#eef1f4;color:var(--ink);font:14px/1.45 "Inter","Segoe UI","Noto Sans","DejaVu Sans",sans-serif}
main{max-width:1020px;margin:24px auto;background:#fff;padding:34px 40px 28px;border-radius:6px;box-shadow:0 1px 4px #0002}
header{display:flex;justify-content:space-between;align-items:baseline;border-bottom:2px solid var(--ink);padding-bottom:10px}
h1{font-size:24px;margin:0;font-weight:650}
h2{font-size:13px;margin:26px 0 8px;text-transform:uppercase;letter-spacing:.06em;color:var(--accent)}
header span{color:var(--soft)}
.badges{margin:14px 0 4px}
.badge{display:inline-block;padding:3px 10px;border-radius:11px;font-size:12.5px;font-weight:600;margin:0 6px 6px 0;border:1px solid}
.good{color:var(--good);background:#e9f5ee}.warn{color:var(--warn);background:#fdf3e4}.bad{color:var(--bad);background:#fdeceb}
.tiles{border-collapse:separate;border-spacing:10px 0;margin:10px -10px 0;width:calc(100% + 20px)}
.tiles td{border:1px solid var(--line);border-radius:5px;padding:10px 12px;text-align:left;width:16%}
.tiles b{font-size:20px;font-weight:650;white-space:nowrap}
.tiles span{color:var(--soft);font-size:12px}
table{border-collapse:collapse;width:100%}
th,td{text-align:right;padding:5px 8px;border-bottom:1px solid var(--line);font-variant-numeric:tabular-nums;vertical-align:top}
td{white-space:nowrap}td.left,.wrap{white-space:normal}
th{font-size:12px;color:var(--soft);font-weight:600}
td:first-child,th:first-child,td.left,th.left{text-align:left}
.plots,.two{table-layout:fixed}
.plots>tbody>tr>td,.two>tbody>tr>td{border:0;padding:0 28px 8px 0;white-space:normal;text-align:left}
.plots>tbody>tr>td+td,.two>tbody>tr>td+td{padding-right:0}
.caption{font-weight:600;margin:12px 0 2px}
.legend{margin:4px 0}
.legend span{color:var(--soft);margin-right:14px}
img{max-width:100%;display:block}
svg{width:100%;height:auto;font:11px "Inter","Segoe UI","Noto Sans","DejaVu Sans",sans-serif;fill:var(--soft)}
svg .grid{stroke:#e6eaee}svg .axis{stroke:var(--ink)}svg .bar{fill:var(--accent)}
svg .mark{stroke:var(--bad);stroke-dasharray:5 4}svg .note{fill:var(--bad)}svg .label{fill:var(--ink)}
code,pre{font:12px "JetBrains Mono","DejaVu Sans Mono",monospace}
pre{background:#f4f6f8;border:1px solid var(--line);border-radius:4px;padding:9px 12px;white-space:pre-wrap;word-break:break-all;margin:0}
.hash{word-break:break-all;color:var(--soft)}
ul{margin:4px 0;padding-left:18px}
footer{margin-top:26px;border-top:1px solid var(--line);padding-top:8px;color:var(--soft);font-size:12px}
@media print{body{background:#fff}main{box-shadow:none;margin:0;max-width:none;padding:0}h2{break-after:avoid}img,svg,tr{break-inside:avoid}}
@media(max-width:760px){.tiles td,.plots>tbody>tr>td,.two>tbody>tr>td{display:block;width:auto}main{padding:18px}}
)";

std::string cell(const std::string& text, bool left = false) {
  return (left ? "<td class=\"left\">" : "<td>") + text + "</td>";
}

std::string fixed(double value, int decimals) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

/// A distance; where it was found shows when it is pointed at.
std::string far_cell(const FarthestPoint& p) {
  return "<td title=\"at " + fixed(p.place[0], 3) + ", " + fixed(p.place[1], 3) + ", " +
         fixed(p.place[2], 3) + "\">" + short_number(p.distance, 3) + "</td>";
}

std::string row(const std::string& name, const std::string& value) {
  return "<tr><td>" + escaped(name) + "</td><td>" + value + "</td></tr>";
}

std::string percent(double share, int digits = 3) {
  return short_number(100 * share, digits) + " %";
}

/// Signed relative difference of the mesh volume to the CAD's, in percent.
std::string difference(double mesh, double cad) {
  if (!(cad > 0)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%+.3f %%", 100 * (mesh - cad) / cad);
  return text;
}

std::string badge(const char* kind, const std::string& text) {
  return std::string("<span class=\"badge ") + kind + "\">" + escaped(text) + "</span>";
}

std::string tile(const std::string& value, const std::string& name) {
  return "<td><b>" + value + "</b><br><span>" + name + "</span></td>";
}

std::string base64(const std::string& bytes) {
  static const char* const digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k > bytes.size() ? '=' : digits[group >> (18 - 6 * k) & 63];
  }
  return out;
}

std::string layers_text(const LayerStats& layers, double value) {
  return layers.places == 0 ? "-" : fixed(value, 2);
}

std::string verdict(const Report& r) {
  std::string html = "<div class=\"badges\">";
  const bool valid = r.validity.valid();
  html += valid ? badge("good", "Valid mesh: every face in one or two elements, none inverted")
                : badge("bad", "Invalid mesh: " + r.validity.first_finding);
  if (r.outcome.cancelled)
    html += badge("warn", "Cancelled: best mesh so far");
  else
    html += r.outcome.converged ? badge("good", "Converged") : badge("warn", "Not converged");
  double worst_volume = 0;
  bool near = true, layers = true;
  for (const BodyOutcome& b : r.outcome.bodies) {
    if (b.cad_volume > 0)
      worst_volume = std::max(worst_volume, std::abs(b.mesh_volume / b.cad_volume - 1));
    near = near && b.boundary_distance.largest() <= b.chord_tolerance * (1 + 1e-9);
    layers = layers && (b.layers.places == 0 ||
                        (b.layers.mean >= b.layers_asked && b.layers.p5 >= 0.9 * b.layers_asked));
  }
  html +=
      badge(layers ? "good" : "warn", layers ? "Layers reached" : "Layers not reached everywhere");
  html += badge(worst_volume <= 5e-3 ? "good" : "warn",
                "Volume within " + short_number(100 * std::max(worst_volume, 1e-6), 2) + " %");
  html += badge(near ? "good" : "warn", near ? "Boundary within the chord tolerance"
                                             : "Boundary beyond the chord tolerance");
  for (const ExportCertificate& c : r.context.exports)
    if (!c.agrees) html += badge("bad", c.file + " does not read back as written");
  return html + "</div>";
}

std::string tiles(const Report& r) {
  const IterationRecord& f = r.final_record;
  double cad = 0, mesh = 0;
  for (const BodyOutcome& b : r.outcome.bodies) {
    cad += b.cad_volume;
    mesh += b.mesh_volume;
  }
  return "<table class=\"tiles\"><tr>" + tile(grouped(f.nodes), "nodes") +
         tile(grouped(f.elements), "tetrahedra") +
         tile(layers_text(f.layers, f.layers.mean), "layers, mean") +
         tile(layers_text(f.layers, f.layers.p5), "layers, 5 % quantile") +
         tile(fixed(f.quality_mean, 3) + " / " + fixed(f.quality_min, 3), "quality, mean / worst") +
         tile(difference(mesh, cad), "volume against CAD") + "</tr></table>";
}

std::string bodies_table(const Report& r) {
  std::string html =
      "<h2>Bodies</h2><table><tr><th>body</th><th>n</th><th>layers mean</th><th>5 %</th>"
      "<th>median</th><th>95 %</th><th>&ge; n</th><th>CAD volume mm&sup3;</th><th>mesh</th>"
      "<th>boundary to part mm</th><th>part to boundary</th><th>tolerance</th><th>h "
      "min</th><th>first mesh by</th></tr>";
  for (const BodyOutcome& b : r.outcome.bodies)
    html += "<tr>" + cell(escaped(b.name), true) + cell(std::to_string(b.layers_asked)) +
            cell(layers_text(b.layers, b.layers.mean)) + cell(layers_text(b.layers, b.layers.p5)) +
            cell(layers_text(b.layers, b.layers.p50)) + cell(layers_text(b.layers, b.layers.p95)) +
            cell(b.layers.places ? percent(b.layers.share_reached) : "-") +
            cell(short_number(b.cad_volume, 6)) + cell(difference(b.mesh_volume, b.cad_volume)) +
            far_cell(b.boundary_distance.to_surface) + far_cell(b.boundary_distance.from_surface) +
            cell(short_number(b.chord_tolerance, 3)) + cell(short_number(b.h_min, 3)) +
            cell(escaped(b.first_mesh_by)) + "</tr>";
  return html + "</table>";
}

/// The places below n that matter most.
std::string below_table(const Report& r) {
  constexpr std::size_t most = 10;
  std::string html;
  for (const BodyOutcome& b : r.outcome.bodies) {
    if (b.below.empty()) continue;
    html += "<h2>" + escaped(b.name) + ": places below n = " + std::to_string(b.layers_asked) +
            "</h2><table><tr><th>layers</th><th>area mm&sup2;</th><th>x mm</th><th>y</th>"
            "<th>z</th></tr>";
    for (std::size_t i = 0; i < std::min(most, b.below.size()); ++i) {
      const PlaceBelow& p = b.below[i];
      html += "<tr>" + cell(fixed(p.layers, 2)) + cell(short_number(p.area, 3)) +
              cell(short_number(p.at[0], 5)) + cell(short_number(p.at[1], 5)) +
              cell(short_number(p.at[2], 5)) + "</tr>";
    }
    html += "</table>";
    if (b.below.size() > most)
      html += "<p>The largest " + std::to_string(most) + " of " + grouped(b.below.size()) +
              "; all are in the JSON report.</p>";
  }
  return html;
}

std::string image(const ReportPicture& picture) {
  return "<p class=\"caption\">" + escaped(picture.caption) + "</p><img alt=\"" +
         escaped(picture.caption) + "\" width=\"" + std::to_string(picture.width) +
         "\" src=\"data:image/png;base64," + base64(picture.png) + "\">";
}

std::string pictures(const Report& r) {
  if (!r.layers_map && r.sections.empty()) return {};
  std::string html = "<h2>The mesh</h2>";
  if (r.layers_map) {
    html += image(*r.layers_map) + "<p class=\"legend\">";
    for (const auto& [color, text] : layers_legend()) {
      char hex[8];
      std::snprintf(hex, sizeof hex, "#%02x%02x%02x", static_cast<unsigned>(255 * color.r),
                    static_cast<unsigned>(255 * color.g), static_cast<unsigned>(255 * color.b));
      html += std::string("<b style=\"background-color:") + hex +
              "\">&nbsp;&nbsp;&nbsp;&nbsp;</b> <span>" + text + "</span> ";
    }
    html += "</p>";
  }
  for (const ReportPicture& section : r.sections) html += image(section);
  return html;
}

std::string overlaps(const Report& r) {
  if (!r.outcome.overlaps) return {};
  const auto& [names, found] = *r.outcome.overlaps;
  const auto pair = [&names = names](int first, int second) {
    return cell(escaped(names[static_cast<std::size_t>(first)] + " and " +
                        names[static_cast<std::size_t>(second)]),
                true);
  };
  const auto volume = [](double value, double error) {
    return cell(short_number(value, 3) + " &plusmn; " + short_number(error, 2));
  };
  const auto place = [](const Vec<3>& x) {
    return cell(short_number(x[0], 4) + ", " + short_number(x[1], 4) + ", " +
                short_number(x[2], 4));
  };
  std::string html = "<h2>Overlaps and gaps between the bodies</h2>";
  if (found.overlaps.empty()) html += "<p>No bodies overlap.</p>";
  if (!found.overlaps.empty()) {
    html +=
        "<table><tr><th>overlap of</th><th>volume mm&sup3;</th><th>depth mm</th>"
        "<th>deepest at mm</th><th></th></tr>";
    for (const Overlap& o : found.overlaps)
      html += "<tr>" + pair(o.first, o.second) + volume(o.volume, o.error) +
              cell(short_number(o.depth, 3)) + place(o.place) +
              cell(o.inner ? escaped(names[static_cast<std::size_t>(*o.inner)]) +
                                 " lies wholly in the other"
                           : "",
                   true) +
              "</tr>";
    html += "</table>";
  }
  if (!found.gaps.empty()) {
    html +=
        "<table><tr><th>gap between</th><th>volume mm&sup3;</th><th>least width mm</th>"
        "<th>mean</th><th>narrowest at mm</th></tr>";
    for (const Gap& g : found.gaps)
      html += "<tr>" + pair(g.first, g.second) + volume(g.volume, g.error) +
              cell(short_number(g.least_width, 3)) + cell(short_number(g.mean_width, 3)) +
              place(g.place) + "</tr>";
    html += "</table>";
  }
  return html;
}

std::string plots(const Report& r) {
  std::string html = "<h2>Measured on the mesh</h2><table class=\"plots\"><tr><td>";
  int asked = 0;
  for (const BodyOutcome& b : r.outcome.bodies) asked = std::max(asked, b.layers_asked);
  html += "<p class=\"caption\">Element quality c(T), 1 is best</p>" +
          svg_histogram(r.quality, "quality in the metric") + "</td><td>";
  html += "<p class=\"caption\">Layers through the walls, measured back</p>" +
          svg_histogram(r.layers, "layers at the nodes of thin walls", asked,
                        "asked: " + std::to_string(asked)) +
          "</td></tr><tr><td>";
  std::vector<Series> series(3);
  series[0].name = "nodes";
  series[1].name = "mean";
  series[2].name = "5 %";
  for (const IterationRecord& record : r.outcome.records) {
    series[0].values.push_back(static_cast<double>(record.nodes));
    series[1].values.push_back(record.layers.mean);
    series[2].values.push_back(record.layers.p5);
  }
  series[1].right = series[2].right = true;
  html += "<p class=\"caption\">Convergence</p>" +
          svg_convergence(series, "left", "layers, right", asked) + "</td><td>";
  html +=
      "<p class=\"caption\">Iterations</p><table><tr><th>it</th><th>nodes</th>"
      "<th>layers</th><th>5 %</th><th>quality</th><th>worst</th><th>s</th></tr>";
  for (const IterationRecord& record : r.outcome.records)
    html += "<tr>" + cell(std::to_string(record.iteration), true) + cell(grouped(record.nodes)) +
            cell(layers_text(record.layers, record.layers.mean)) +
            cell(layers_text(record.layers, record.layers.p5)) +
            cell(fixed(record.quality_mean, 3)) + cell(fixed(record.quality_min, 3)) +
            cell(fixed(record.seconds, 1)) + "</tr>";
  return html + "</table></td></tr></table>";
}

std::string conformity_and_settings(const Report& r) {
  const IterationRecord& f = r.final_record;
  const MeshReport& v = r.validity;
  const StudyOptions& o = r.study.options;
  std::string html = "<table class=\"two\"><tr><td><h2>Figures</h2><table>";
  html += row("boundary triangles", grouped(v.faces_boundary));
  html += row("inverted elements", grouped(v.inverted));
  html += row("faces of more than two elements", grouped(v.faces_shared));
  html += row("free boundary faces not listed", grouped(v.facets_missing));
  html += row("volume, by elements", short_number(v.volume, 8) + " mm&sup3;");
  html += row("volume, by the boundary", short_number(v.volume_boundary, 8) + " mm&sup3;");
  html += row("boundary area", short_number(v.boundary_area, 8) + " mm&sup2;");
  html += row("conformity to the metric (0 is perfect)", fixed(f.conformity, 3));
  html += row("unit edges", percent(f.unit_edges));
  html += "</table></td><td><h2>Settings</h2><table>";
  for (const BodyOutcome& b : r.outcome.bodies) {
    const BodySettings s = settings_of(r.study, b.name);
    html += row(b.name + ": n, alpha", std::to_string(s.layers) + ", " + short_number(s.alpha));
    if (s.layers2)
      html +=
          row(b.name + ": n2, alpha2", std::to_string(*s.layers2) + ", " + short_number(s.alpha2));
    if (s.layers3) html += row(b.name + ": n3", std::to_string(*s.layers3));
    html += row(b.name + ": h min, h max",
                short_number(b.h_min) + " mm, " +
                    (s.h_max ? short_number(*s.h_max) + " mm" : std::string("no bound")));
  }
  for (const SizingObject& object : r.study.sizing)
    html += row("size corrected by",
                escaped(object.name + (object.body.empty() ? "" : ", " + object.body)));
  html += row("chord tolerance", o.chord_tolerance ? short_number(*o.chord_tolerance) + " mm"
                                                   : "1/1000 of each body's diagonal");
  if (o.max_anisotropy) html += row("anisotropy at most", short_number(*o.max_anisotropy));
  html += row("angle tolerance", short_number(o.angle_tolerance) + " rad");
  html += row("iterations at most",
              std::to_string(o.iterations) + (o.progressive ? ", with 2, 3, .. n layers" : ""));
  html += row("threads", o.threads ? std::to_string(o.threads) : "all cores");
  html += row("seed", std::to_string(o.seed));
  html += row("detector", std::string(detector_name(o.detector)));
  html += row("time", short_number(r.outcome.seconds, 3) + " s");
  return html + "</table></td></tr></table>";
}

std::string solvers(const Report& r) {
  std::string html =
      "<h2>What this mesh is fit for</h2><table><tr><th>solver</th><th "
      "class=\"left\">criterion</th>"
      "<th>here</th><th>asked</th><th class=\"left\">verdict</th></tr>";
  std::string before;
  for (const FitnessLine& line : fitness_lines(r)) {
    html += "<tr>" + cell(line.solver == before ? "" : line.solver, true) +
            cell(line.criterion, true) + cell(line.value) + cell(line.bound) +
            cell(line.bound.empty() ? "told"
                 : line.holds       ? "<b class=\"good\">holds</b>"
                                    : "<b class=\"bad\">does not hold.</b> " + line.advice,
                 true) +
            "</tr>";
    before = line.solver;
  }
  return html + "</table>";
}

std::string files(const Report& r) {
  std::string html;
  if (!r.context.inputs.empty()) {
    html +=
        "<h2>Inputs</h2><table><tr><th>file</th><th>bytes</th><th class=\"left\">SHA-256</th></tr>";
    for (const InputFile& i : r.context.inputs)
      html += "<tr>" + cell(escaped(i.path), true) + cell(grouped(i.bytes)) +
              "<td class=\"left hash\"><code>" + i.sha256 + "</code></td></tr>";
    html += "</table>";
  }
  if (!r.context.exports.empty()) {
    html +=
        "<h2>Exports, read back and compared</h2><table><tr><th>file</th>"
        "<th class=\"left\">format</th><th class=\"left\">names, areas and volumes</th></tr>";
    for (const ExportCertificate& c : r.context.exports)
      html +=
          "<tr>" + cell(escaped(c.file), true) + cell(escaped(c.format), true) +
          cell(c.agrees ? "agree (largest difference " + short_number(c.worst_difference, 2) + ")"
                        : "<b class=\"bad\">" + escaped(c.finding) + "</b>",
               true) +
          "</tr>";
    html += "</table>";
  }
  std::string notes;
  for (const ExportCertificate& c : r.context.exports)
    for (const std::string& note : c.notes)
      notes += "<li>" + escaped(c.file) + ": " + escaped(note) + "</li>";
  for (const BodyOutcome& b : r.outcome.bodies)
    for (const std::string& note : b.notes)
      notes += "<li>" + escaped(b.name + ": " + note) + "</li>";
  if (!notes.empty()) html += "<h2>Notes</h2><ul>" + notes + "</ul>";
  if (!r.context.command.empty())
    html += "<h2>To make this mesh again</h2><pre>" + escaped(r.context.command) + "</pre>";
  return html;
}

}  // namespace

std::string report_html(const Report& report) {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
         "<meta name=\"viewport\" content=\"width=device-width\"><title>" +
         escaped(report.study.name) + " - mesh report</title><style>" + kStyle +
         "</style></head>\n<body><main><header><h1>" + escaped(report.study.name) +
         "</h1><span>Mesh report &middot; Lamella " + version() + "</span></header>\n" +
         verdict(report) + tiles(report) + bodies_table(report) + pictures(report) +
         below_table(report) + plots(report) + overlaps(report) + conformity_and_settings(report) +
         solvers(report) + files(report) +
         "<footer>Lengths in mm. Quality, conformity and edges are measured in the metric asked; "
         "layers are counted from wall to wall in the mesh's own metric; boundary to part and part "
         "to "
         "boundary are the largest distances of any point of one to the other, the part as it was "
         "tessellated.</footer>"
         "</main></body></html>\n";
}

}  // namespace lamella
