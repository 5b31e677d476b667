#pragma once

#include "core/study/run.h"

namespace lamella {

/// One mesh of the study's domain that carries all its bodies, parts and zones (chapter 6): the
/// loop of `run` for a study with a domain. Of bodies that overlap the first keeps what they share;
/// parts come before zones, each in the order given. Errors: as `run`; usage also for a domain that
/// is no body, and for bodies outside of it.
Result<Outcome> run_assembly(const Study& study, const std::vector<Part>& parts,
                             const std::vector<std::shared_ptr<const VolumeMesher>>& meshers,
                             const Progress& progress, const IterationSink& on_iteration,
                             const SolverField* field = nullptr);

}  // namespace lamella
