#include "ui/session/recovery.h"

#include <unistd.h>

#include <QFileInfo>
#include <algorithm>
#include <csignal>
#include <string>
#include <system_error>

#include "core/base/atomic_file.h"
#include "core/project/project_file.h"
#include "core/study/study_file.h"
#include "ui/session/session.h"

namespace lamella::ui {
namespace {

namespace fs = std::filesystem;

/// Beside the study: the file it is to be saved to.
fs::path target_file(fs::path study) { return study.replace_extension(".target"); }

}  // namespace

bool program_runs(const std::string& pid) {
  const long number = std::strtol(pid.c_str(), nullptr, 10);
  return number > 0 && (kill(static_cast<pid_t>(number), 0) == 0 || errno == EPERM);
}

Recovery::Recovery(Session& session, fs::path folder)
    : QObject(&session),
      session_(session),
      folder_(std::move(folder)),
      file_(folder_ / (std::to_string(getpid()) + ".lamella")) {
  wait_.setSingleShot(true);
  wait_.setInterval(1000);
  connect(&wait_, &QTimer::timeout, this, &Recovery::keep);
  connect(&session, &Session::study_changed, this, [this] {
    if (session_.modified())
      wait_.start();
    else
      drop();
  });
}

Recovery::~Recovery() { drop(); }

void Recovery::keep() {
  if (!session_.modified()) return drop();
  std::error_code ec;
  fs::create_directories(folder_, ec);
  // A full disk must not keep the user from working; saving tells of it.
  if (write_study(seen_from(session_.study(), {}), file_))
    (void)write_file(target_file(file_), session_.file().string());
}

void Recovery::drop() {
  wait_.stop();
  discard({file_, {}, {}});
}

std::vector<Recovery::Left> Recovery::left_behind() const {
  std::vector<Left> left;
  std::error_code ec;
  for (const auto& entry : fs::directory_iterator(folder_, ec)) {
    const fs::path& file = entry.path();
    if (file.extension() != ".lamella" || program_runs(file.stem().string())) continue;
    const Result<std::string> target = read_file(target_file(file));
    left.push_back({file, target ? fs::path(*target) : fs::path(),
                    QFileInfo(QString::fromStdString(file.string())).lastModified()});
  }
  std::sort(left.begin(), left.end(),
            [](const Left& a, const Left& b) { return a.written < b.written; });
  return left;
}

void Recovery::discard(const Left& left) {
  std::error_code ec;
  fs::remove(left.file, ec);
  fs::remove(target_file(left.file), ec);
}

}  // namespace lamella::ui
