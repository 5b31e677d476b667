#include "core/study/study_file.h"

#include <gtest/gtest.h>

#include "core/base/atomic_file.h"
#include "tests/support/temporary_folder.h"

namespace lamella {
namespace {

Study full_study() {
  Study study;
  study.name = "Tr\u00e4ger \"A\"";
  study.inputs = {"parts/a.step", "/abs/b.stl"};
  study.bodies = {{"cover", 6, 0.5, 0.01, 3.5, false}, {"lid"}};
  study.options = {0.02, 0.2, 9, 3, 12345678901234567890u, Detector::neighborhood};
  return study;
}

TEST(StudyFile, ReadsBackWhatItWrote) {
  const test::TemporaryFolder folder;
  const Study study = full_study();
  ASSERT_TRUE(write_study(study, folder / "s.json").ok());
  const Result<Study> back = read_study(folder / "s.json");
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(back->name, study.name);
  EXPECT_EQ(back->inputs, study.inputs);
  ASSERT_EQ(back->bodies.size(), 2u);
  EXPECT_EQ(back->bodies[0].name, "cover");
  EXPECT_EQ(back->bodies[0].layers, 6);
  EXPECT_EQ(back->bodies[0].alpha, 0.5);
  EXPECT_EQ(back->bodies[0].h_min, 0.01);
  EXPECT_EQ(back->bodies[0].h_max, 3.5);
  EXPECT_FALSE(back->bodies[0].visible);
  EXPECT_FALSE(back->bodies[1].h_min.has_value());
  EXPECT_EQ(back->options.chord_tolerance, 0.02);
  EXPECT_EQ(back->options.angle_tolerance, 0.2);
  EXPECT_EQ(back->options.iterations, 9);
  EXPECT_EQ(back->options.threads, 3);
  EXPECT_EQ(back->options.seed, 12345678901234567890u);
  EXPECT_EQ(back->options.detector, Detector::neighborhood);
  EXPECT_EQ(study_to_json(*back), study_to_json(study));
}

TEST(StudyFile, LeftOutMeansDefault) {
  const Result<Study> study = study_from_json(R"({"schema": 1, "bodies": [{"name": "a"}]})", "s");
  ASSERT_TRUE(study.ok());
  EXPECT_EQ(study->bodies.at(0).layers, BodySettings{}.layers);
  EXPECT_EQ(study->options.iterations, StudyOptions{}.iterations);
  EXPECT_EQ(study->options.detector, Detector::geometric);
}

TEST(StudyFile, EveryMistakeIsNamed) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "JSON"},
      {"{\"schema\": 1", "JSON"},
      {"[]", "schema"},
      {R"({"schema": 2})", "newer"},
      {R"({"schema": 1, "bodys": []})", "bodys"},
      {R"({"schema": 1, "inputs": [1]})", "inputs"},
      {R"({"schema": 1, "bodies": [{"layers": 4}]})", "bodies[0].name"},
      {R"({"schema": 1, "bodies": [{"name": "a", "layers": 0}]})", "bodies[0].layers"},
      {R"({"schema": 1, "bodies": [{"name": "a", "layers": 2.5}]})", "bodies[0].layers"},
      {R"({"schema": 1, "bodies": [{"name": "a", "h_min": -1}]})", "bodies[0].h_min"},
      {R"({"schema": 1, "options": {"iterations": "six"}})", "options.iterations"},
      {R"({"schema": 1, "options": {"detector": "radar"}})", "options.detector"},
      {R"({"schema": 1, "options": {"tolerance": 1}})", "options.tolerance"},
      {R"({"schema": 1, "unit": "inch"})", "unit"}};
  for (const auto& [text, named] : cases) {
    const Result<Study> study = study_from_json(text, "bad.json");
    ASSERT_FALSE(study.ok()) << text;
    EXPECT_EQ(study.error().code, Code::bad_input);
    EXPECT_NE(study.error().message.find(named), std::string::npos) << study.error().message;
    EXPECT_NE(study.error().message.find("bad.json"), std::string::npos);
  }
}

TEST(StudyFile, InputsAreSeenFromTheStudysFolder) {
  const auto files = input_files(full_study(), "/data/job");
  EXPECT_EQ(files.at(0), "/data/job/parts/a.step");
  EXPECT_EQ(files.at(1), "/abs/b.stl");
}

TEST(Settings, APartWithoutAnEntryGetsTheDefaults) {
  const Study study = full_study();
  EXPECT_EQ(settings_of(study, "cover").layers, 6);
  EXPECT_EQ(settings_of(study, "other").layers, BodySettings{}.layers);
  EXPECT_EQ(settings_of(study, "other").name, "other");
}

}  // namespace
}  // namespace lamella
