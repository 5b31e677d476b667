#include <QElapsedTimer>
#include <algorithm>
#include <utility>

#include "core/study/moved_faces.h"
#include "core/study/study_file.h"
#include "ui/commands/edit_study.h"
#include "ui/session/session.h"
#include "ui/session/zone_shapes.h"

// The part of a session that knows of bodies without a file, and of several in one place.
namespace lamella::ui {
namespace {

/// Takes what asks for the body by its name out of the study.
void forget_body(Study& study, const std::string& name) {
  std::erase_if(study.sizing, [&](const SizingObject& object) { return object.body == name; });
  if (study.domain && study.domain->shape == decltype(study.domain->shape){DomainBody{name}})
    study.domain = StudyDomain{DomainBodies{}};
}

}  // namespace

bool Session::follow_bodies() {
  const auto same = [&](const auto& a, const auto& b) {
    return a.zones == b.zones && a.domain == b.domain && a.bodies.size() == b.bodies.size();
  };
  if (shaped_ && shaped_parts_ == parts_ && same(*shaped_, *study_)) return false;
  if (!shaped_ || shaped_parts_ != parts_ || shaped_->zones != study_->zones) drop_overlaps();
  const std::shared_ptr<const std::vector<Part>> old = shapes_;
  shapes_ = parts_;
  if (study_->bodies.size() > parts_->size()) {
    auto all = std::make_shared<std::vector<Part>>(*parts_);
    for (std::size_t k = parts_->size(); k < study_->bodies.size(); ++k) {
      Part shape;
      shape.name = study_->bodies[k].name;
      // Until its own arrives the last one will do.
      for (const Part& known : *old)
        if (known.name == shape.name) shape = known;
      all->push_back(std::move(shape));
    }
    shapes_ = all;
  }
  if (!study_->domain) hull_ = {};
  shaped_ = study_;
  shaped_parts_ = parts_;
  ++shaped_round_;
  std::erase_if(selection_, [&](int k) { return k >= static_cast<int>(study_->bodies.size()); });
  if (std::find(selection_.begin(), selection_.end(), selected_) == selection_.end())
    selected_ = selection_.empty() ? -1 : selection_.back();
  if (shaper_.busy())
    shaper_.cancel();
  else
    take_zone_shapes();
  return true;
}

void Session::take_zone_shapes() {
  if (study_->zones.empty() && !study_->domain) return;
  if (drawn_round_ == shaped_round_) return;
  shaper_.start([this, study = shaped_, parts = parts_,
                 round = shaped_round_](const Progress& progress) -> Worker::Done {
    ZoneShapes made = zone_shapes(*study, *parts, progress);
    return [this, round, study, made = std::move(made)]() mutable {
      if (round != shaped_round_) return;
      drawn_round_ = round;
      auto all = std::make_shared<std::vector<Part>>(*shapes_);
      for (std::size_t z = 0; z < made.zones.size(); ++z) {
        Part& shape = (*all)[parts_->size() + z];
        shape.surface = std::move(made.zones[z]);
        shape.cad_volume = made.volumes[z];
      }
      shapes_ = all;
      hull_ = std::move(made.hull);
      Q_EMIT surfaces_changed();
    };
  });
}

void Session::drop_overlaps() {
  if (!overlaps_) return;
  overlaps_.reset();
  Q_EMIT overlaps_changed();
}

void Session::remove_part(int index) {
  if (activity_ != Activity::idle || !is_part(index)) return;
  Study study = *study_;
  std::vector<Part> rest = *parts_;
  rest.erase(rest.begin() + index);
  const std::string name = (*parts_)[static_cast<std::size_t>(index)].name;
  study.left_out.push_back(name);
  std::erase_if(study.groups, [&](const BoundaryGroup& group) { return group.body == name; });
  forget_body(study, name);
  arrange_bodies(study, rest);
  undo_.push(new RemovePart(*this, index, std::make_shared<Study>(std::move(study))));
  select(std::min(index, static_cast<int>(study_->bodies.size()) - 1));
}

Session::TakenPart Session::take_part(int index, std::shared_ptr<const Study> after) {
  auto rest = std::make_shared<std::vector<Part>>(*parts_);
  const auto at = static_cast<std::size_t>(index);
  TakenPart taken{std::move((*rest)[at]), sources_[at], read_with_};
  rest->erase(rest->begin() + index);
  sources_.erase(sources_.begin() + index);
  parts_ = std::move(rest);
  set_study(std::move(after));
  return taken;
}

void Session::put_back(int index, TakenPart taken, std::shared_ptr<const Study> after) {
  auto all = std::make_shared<std::vector<Part>>(*parts_);
  all->insert(all->begin() + index, std::move(taken.part));
  sources_.insert(sources_.begin() + index, std::move(taken.source));
  surfaces_differ_ =
      surfaces_differ_ || taken.read_with.chord_tolerance != read_with_.chord_tolerance;
  parts_ = std::move(all);
  set_study(std::move(after));
  select(index);
}

Session::ReadState Session::exchange_parts(ReadState now) {
  ReadState before{std::exchange(parts_, std::move(now.parts)),
                   std::exchange(sources_, std::move(now.sources)), study_};
  set_study(std::move(now.study));
  return before;
}

void Session::reload() {
  if (activity_ != Activity::idle || parts_->empty()) return;
  Q_EMIT logged(tr("Reading the files of the parts again"));
  std::vector<StudyInput> inputs = study_->inputs;
  std::vector<std::filesystem::path> files;
  for (std::size_t k = 0; k < inputs.size(); ++k)
    files.push_back(k < project_.files.size() ? project_.files[k]
                                              : std::filesystem::path(inputs[k].file));
  begin(
      Activity::loading,
      [this, inputs = std::move(inputs), files = std::move(files), left_out = study_->left_out,
       params = read_with_](const Progress& progress) mutable -> Worker::Done {
        bool changed = false;
        const auto read = [&]() -> Result<ReadParts> {
          std::vector<double> units;
          for (std::size_t k = 0; k < files.size(); ++k) {
            const std::string before = inputs[k].sha256;
            if (const Result<void> known = identify(inputs[k], files[k]); !known)
              return known.error();
            changed = changed || inputs[k].sha256 != before;
            units.push_back(inputs[k].unit);
          }
          if (!changed) return ReadParts{};
          Result<ReadParts> parts = read_parts(services_, files, units, params, progress);
          if (parts) name_parts(*parts, 0, left_out, true);
          return parts;
        };
        Result<ReadParts> made = read();
        return [this, changed, made = std::move(made), inputs = std::move(inputs)]() mutable {
          set_activity(Activity::idle);
          if (!made) return report(made.error());
          if (!changed) return Q_EMIT noticed(tr("The parts are as their files have them."), {});
          Study study = *study_;
          study.inputs = std::move(inputs);
          std::vector<std::string> notes =
              move_faces(study, known_faces(study, *parts_), made->parts);
          for (std::string& note : unmatched(study, made->parts)) notes.push_back(note);
          arrange_bodies(study, made->parts);
          const std::size_t count = made->parts.size();
          undo_.push(new ReloadParts(
              *this, {std::make_shared<const std::vector<Part>>(std::move(made->parts)),
                      std::move(made->sources), std::make_shared<const Study>(std::move(study))}));
          const QString what = count == 1 ? tr("The part was read again.")
                                          : tr("%1 parts were read again.").arg(count);
          if (notes.empty())
            Q_EMIT noticed(what, tr("Its settings, groups and sizes are as they were."));
          else
            tell(what, notes);
        };
      });
}

void Session::remove_zone(int index) {
  if (!is_zone(index)) return;
  Study study = *study_;
  const std::string name = study.bodies[static_cast<std::size_t>(index)].name;
  study.zones.erase(study.zones.begin() + (index - static_cast<int>(parts_->size())));
  forget_body(study, name);
  // The last body takes what is around it along.
  if (study.zones.empty() && parts_->empty()) study.domain.reset();
  arrange_bodies(study, *parts_);
  edit(tr("Remove zone %1").arg(QString::fromStdString(name)), std::move(study));
}

void Session::look_for_overlaps(double gap_width) {
  if (activity_ != Activity::idle || !has_bodies()) return;
  Q_EMIT logged(tr("Looking for overlaps and gaps"));
  begin(
      Activity::checking,
      [this, study = study_, parts = parts_, gap_width](const Progress& progress) -> Worker::Done {
        QElapsedTimer clock;
        clock.start();
        OverlapOptions options;
        options.gap_width = gap_width;
        Result<StudyOverlaps> found =
            study_overlaps(*study, *parts, options, progress.portion(0, 1, "overlaps and gaps"));
        const double seconds = static_cast<double>(clock.elapsed()) / 1000;
        return [this, found = std::move(found), parts, study, gap_width, seconds]() mutable {
          set_activity(Activity::idle);
          if (!found) return report(found.error());
          if (parts != parts_ || study->zones != study_->zones) return;
          Q_EMIT logged(tr("%1 overlaps and %2 gaps")
                            .arg(found->report.overlaps.size())
                            .arg(found->report.gaps.size()));
          overlaps_ = OverlapCheck{std::move(*found), gap_width, seconds};
          Q_EMIT overlaps_changed();
        };
      });
}

}  // namespace lamella::ui
