#include "core/io/export_certificate.h"

#include <algorithm>

namespace lamella {

namespace {

void compare(const std::string& what, std::vector<NamedMeasure> a, std::vector<NamedMeasure> b,
             bool names, double tolerance, ExportCertificate& out) {
  if (!names)
    for (auto* list : {&a, &b})
      std::erase_if(*list, [](const NamedMeasure& entry) { return entry.count == 0; });
  if (a.size() != b.size()) {
    out.finding += std::to_string(a.size()) + " " + what + " written, " + std::to_string(b.size()) +
                   " read back. ";
    return;
  }
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (names && a[i].name != b[i].name)
      out.finding += what + " \"" + a[i].name + "\" reads back as \"" + b[i].name + "\". ";
    if (a[i].count != b[i].count)
      out.finding += what + " \"" + a[i].name + "\": " + std::to_string(a[i].count) + " written, " +
                     std::to_string(b[i].count) + " read back. ";
    const double scale = std::max(std::abs(a[i].measure), std::abs(b[i].measure));
    const double difference = scale > 0 ? std::abs(a[i].measure - b[i].measure) / scale : 0;
    out.worst_difference = std::max(out.worst_difference, difference);
    if (!(difference <= tolerance))
      out.finding += what + " \"" + a[i].name + "\": measure differs. ";
  }
}

}  // namespace

MeshSummary summarize(const SimplexMesh<3>& mesh) {
  MeshSummary s;
  s.nodes = mesh.node_count();
  for (const std::string& name : mesh.bodies) s.bodies.push_back({name, 0, 0});
  for (const std::string& name : mesh.groups) s.groups.push_back({name, 0, 0});
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    NamedMeasure& body = s.bodies.at(mesh.element_body[e]);
    ++body.count;
    body.measure += signed_measure<3>(mesh.corners(mesh.elements[e]));
  }
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    NamedMeasure& group = s.groups.at(mesh.facet_group[f]);
    ++group.count;
    group.measure += 0.5 * facet_normal<3>(mesh.corners(mesh.facets[f])).norm();
  }
  return s;
}

ExportCertificate certify(const std::string& file, const std::string& format,
                          const MeshSummary& written, const MeshSummary& read_back, bool names,
                          double tolerance) {
  ExportCertificate out;
  out.file = file;
  out.format = format;
  out.read_back = read_back;
  if (written.nodes != read_back.nodes)
    out.finding += std::to_string(written.nodes) + " nodes written, " +
                   std::to_string(read_back.nodes) + " read back. ";
  compare("body", written.bodies, read_back.bodies, names, tolerance, out);
  compare("group", written.groups, read_back.groups, names, tolerance, out);
  if (!out.finding.empty()) out.finding.pop_back();
  out.agrees = out.finding.empty();
  return out;
}

}  // namespace lamella
