#pragma once

#include <QCommandLineParser>
#include <string>
#include <vector>

namespace lamella {

/// The command line of the window's program.
class WindowOptions {
 public:
  WindowOptions();

  /// Ends the program where it asks for the help or the version, or is none.
  void process(const QCoreApplication& application) { parser_.process(application); }
  bool isSet(const QString& name) const { return parser_.isSet(name); }
  QString value(const QString& name) const { return parser_.value(name); }
  QStringList files() const { return parser_.positionalArguments(); }
  /// The manual page of the program, section 1: what --help says.
  std::string manual_page() const;

 private:
  void add(const QCommandLineOption& option);

  QCommandLineParser parser_;
  std::vector<QCommandLineOption> shown_;  // by the help
};

}  // namespace lamella
