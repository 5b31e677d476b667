#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/study/study.h"

namespace lamella::cli {

/// One `--set PATH=VALUE,VALUE..`. The path names a member of the study's JSON, entries of lists by
/// their name or their number from 0; body.MEMBER is that of every body, and body.n its layers.
struct Setting {
  std::string path;
  std::vector<std::string> values;  ///< JSON, or text where it is none
};

/// Commas within brackets or quotes part no values. Errors: usage.
Result<Setting> read_setting(const std::string& text);

/// A value for each setting.
using Combination = std::vector<std::string>;

/// All combinations of the values, the last setting changing fastest; one without values if there
/// are no settings. Errors: usage (too many).
Result<std::vector<Combination>> combinations_of(const std::vector<Setting>& settings);

/// The study with the values in it. Its bodies are those it has an entry for. Errors: usage, naming
/// the path and what it may be.
Result<Study> with_settings(const Study& study, const std::vector<Setting>& settings,
                            const Combination& values);

}  // namespace lamella::cli
