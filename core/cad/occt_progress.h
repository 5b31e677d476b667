#pragma once

#include <Message_ProgressIndicator.hxx>
#include <Message_ProgressScope.hxx>

#include "core/base/progress.h"

namespace lamella {

/// Carries OCCT's progress and break requests to ours. Private to core/cad.
class OcctProgress : public Message_ProgressIndicator {
 public:
  explicit OcctProgress(Progress progress) : progress_(std::move(progress)) {}

 protected:
  Standard_Boolean UserBreak() override { return progress_.cancelled(); }
  void Show(const Message_ProgressScope&, Standard_Boolean) override {
    progress_.report(GetPosition());
  }

 private:
  Progress progress_;
};

}  // namespace lamella
