#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "app/cli_console.h"
#include "core/io/export_certificate.h"
#include "core/io/medit.h"
#include "core/mesh/check.h"
#include "core/metric/metric.h"
#include "core/natural/boundary_distance.h"

namespace lamella::cli {

/// What several subcommands share.

using Json = nlohmann::ordered_json;

/// One line; bytes that are not UTF-8 (file names may have them) are replaced.
std::string dump(const Json& json);

/// Whatever keeps an input from being read, it is the input that is bad.
Error of_input(Error error);

/// A mesh file of any kind; `metric` (may be null) gets the metric of an .msh or .vtu, if it has
/// one.
Result<AnyMesh> read_any(const std::string& file, MetricField<3>* metric, const Progress& progress);

/// The metric asked at the nodes: from a .sol file, analytic, or none (empty). `function` (may be
/// null) gets the analytic one.
template <int D>
Result<MetricField<D>> metric_of(const SimplexMesh<D>& mesh, const std::string& sol,
                                 const std::string& name, MetricFunction<D>* function);

/// Whether a mesh of the dimension can be written to the file: only Medit knows others than 3.
Result<void> check_output_name(const std::string& output, int dimension);
/// Writes a mesh with its metric (may be empty): any format in 3D, else a .mesh with its .sol.
template <int D>
Result<void> write_any(const std::string& output, SimplexMesh<D>&& mesh, MetricField<D>&& metric,
                       const Progress& progress = {});

/// That a file was written, and the notes of its certificate.
void tell_written(const std::string& file, const ExportCertificate& proof, Console& console);

/// The findings of a check, without those about the metric where there is none.
Json report_json(const CheckReport& report, bool with_metric);

/// A distance with the place where it was found.
Json farthest_json(const FarthestPoint& point);

}  // namespace lamella::cli
