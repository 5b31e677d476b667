#include "core/project/project_file.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <random>
#include <thread>

#include "core/base/atomic_file.h"
#include "core/base/sha256.h"
#include "core/project/archive.h"
#include "core/study/study_file.h"
#include "tests/support/raw_zip.h"
#include "tests/support/temporary_folder.h"

namespace lamella {
namespace {

namespace fs = std::filesystem;
using test::raw_zip;
using Names = std::vector<std::string>;

struct ProjectFile : testing::Test {
  test::TemporaryFolder folder;
  const fs::path file = folder / "s.lamella";

  void write(const std::string& name, const std::string& bytes) {
    fs::create_directories((folder / name).parent_path());
    ASSERT_TRUE(write_file(folder / name, bytes));
  }
  /// A study of parts/a.stl, read a moment ago, with a mesh that is `mesh`.
  ProjectContent content(const std::string& mesh = "a mesh") {
    write("parts/a.stl", "solid a");
    ProjectContent made;
    made.study.name = "s";
    made.study.inputs = {{(folder / "parts/a.stl").string(), 25.4}};
    EXPECT_TRUE(identify(made.study.inputs[0], folder / "parts/a.stl"));
    made.study.bodies = {{"a", 3}};
    if (!mesh.empty())
      made.write_mesh = [mesh](const fs::path& vtu) { return write_file(vtu, mesh); };
    return made;
  }
  Project opened() {
    Result<Project> project = open_project(file);
    EXPECT_TRUE(project) << project.error().message;
    return project ? std::move(*project) : Project{};
  }
  std::string refusal() {
    const Result<Project> project = open_project(file);
    if (project) return "";
    EXPECT_EQ(project.error().code, Code::bad_input);
    EXPECT_FALSE(project.error().hint.empty()) << project.error().message;
    return project.error().message;
  }
};

TEST_F(ProjectFile, HoldsStudyMeshAndReport) {
  ProjectContent saved = content();
  Study before = saved.study;
  before.bodies[0].layers = 2;
  saved.mesh_study = before;
  saved.report_json = "{}";
  saved.report_html = "<html>";
  const Result<Names> notes = save_project(saved, file);
  ASSERT_TRUE(notes) << notes.error().message;
  EXPECT_TRUE(notes->empty());
  EXPECT_EQ(folder.names(), (Names{"parts", "s.lamella"}));
  const Result<Archive> zip = Archive::open(file);
  ASSERT_TRUE(zip);
  EXPECT_NE(zip->read(*zip->find("project.json"), 10000)->find("\"parts/a.stl\""),
            std::string::npos)
      << "a project can be moved with its parts";

  fs::path unpacked;
  {
    const Project back = opened();
    EXPECT_EQ(study_to_json(back.study), study_to_json(saved.study));
    EXPECT_EQ(back.files, std::vector<fs::path>{folder / "parts/a.stl"});
    EXPECT_EQ(back.mesh.extension(), ".vtu");
    EXPECT_EQ(read_file(back.mesh).value(), "a mesh");
    ASSERT_TRUE(back.mesh_study);
    EXPECT_EQ(mesh_key(*back.mesh_study), mesh_key(before));
    EXPECT_NE(mesh_key(*back.mesh_study), mesh_key(back.study));
    EXPECT_EQ(back.report_json, "{}");
    EXPECT_EQ(back.report_html, "<html>");
    EXPECT_TRUE(back.notes.empty());
    unpacked = back.mesh;
  }
  EXPECT_FALSE(fs::exists(unpacked)) << "what was unpacked goes with the project";
}

TEST_F(ProjectFile, ItsHeadIsReadWithoutMeshAndInputs) {
  ProjectContent saved = content();
  saved.report_json = "{}";
  ASSERT_TRUE(save_project(saved, file));
  fs::remove_all(folder / "parts");
  const Result<Project> head = open_project_head(file);
  ASSERT_TRUE(head) << head.error().message;
  ASSERT_TRUE(head->mesh_study);
  EXPECT_EQ(mesh_key(*head->mesh_study), mesh_key(saved.study));
  EXPECT_EQ(head->report_json, "{}");
  EXPECT_TRUE(head->mesh.empty() && head->files.empty() && !head->folder);
  ASSERT_TRUE(save_project(content(""), file));
  EXPECT_FALSE(open_project_head(file)->mesh_study);
}

TEST_F(ProjectFile, AChangedInputIsToldAndReadAnew) {
  ASSERT_TRUE(save_project(content(), file));
  write("parts/a.stl", "solid b");
  const Project back = opened();
  ASSERT_EQ(back.notes.size(), 1u);
  EXPECT_NE(back.notes[0].find("a.stl\" has changed"), std::string::npos);
  EXPECT_EQ(back.study.inputs[0].sha256, sha256("solid b"));
  EXPECT_EQ(back.study.bodies.at(0).layers, 3);
  EXPECT_NE(mesh_key(*back.mesh_study), mesh_key(back.study)) << "the mesh is of another part";
}

TEST_F(ProjectFile, AMissingInputIsTakenFromTheProjectOrMissed) {
  ProjectContent saved = content();
  ASSERT_TRUE(save_project(saved, file));
  fs::remove(folder / "parts/a.stl");
  EXPECT_NE(refusal().find("parts/a.stl\" is missing"), std::string::npos);

  saved = content();
  saved.study.embed_inputs = true;
  ASSERT_TRUE(save_project(saved, file));
  fs::remove_all(folder / "parts");
  const Project back = opened();
  ASSERT_EQ(back.files.size(), 1u);
  EXPECT_EQ(back.files[0].filename(), "a.stl") << "parts are called as their files";
  EXPECT_EQ(read_file(back.files[0]).value(), "solid a");
  EXPECT_EQ(back.study.inputs[0].file, (folder / "parts/a.stl").string()) << "still linked there";
  EXPECT_EQ(back.notes.size(), 1u);
  EXPECT_EQ(mesh_key(*back.mesh_study), mesh_key(back.study));
  // Saved elsewhere it takes the copy along.
  ProjectContent again;
  again.study = back.study;
  again.copies = back.copies;
  ASSERT_TRUE(save_project(again, folder / "t.lamella"));
  const Result<Project> moved = open_project(folder / "t.lamella");
  ASSERT_TRUE(moved) << moved.error().message;
  EXPECT_EQ(read_file(moved->files[0]).value(), "solid a");
  // A text that was kept of the same study finds it there.
  write("kept.json", study_to_json(back.study));
  EXPECT_FALSE(open_project(folder / "kept.json"));
  const Result<Project> kept = open_project(folder / "kept.json", {}, file);
  ASSERT_TRUE(kept) << kept.error().message;
  EXPECT_EQ(read_file(kept->files[0]).value(), "solid a");
}

TEST_F(ProjectFile, AResultOfAnotherSolverIsLinkedOrCopiedLikeAPart) {
  ProjectContent saved = content("");
  write("results/solved.vtu", "a result");
  StudyFlow flow;
  flow.method = FlowMethod::field;
  flow.field = StudyField{{(folder / "results/solved.vtu").string(), 1000}, "T"};
  EXPECT_TRUE(identify(flow.field->source, folder / "results/solved.vtu"));
  saved.study.flow = flow;
  ASSERT_TRUE(save_project(saved, file));
  const Result<Archive> zip = Archive::open(file);
  ASSERT_TRUE(zip);
  EXPECT_NE(zip->read(*zip->find("project.json"), 10000)->find("\"results/solved.vtu\""),
            std::string::npos)
      << "a project can be moved with its results";
  EXPECT_EQ(opened().study.flow, saved.study.flow);
  EXPECT_TRUE(opened().notes.empty());

  // Another content is told, and makes another mesh.
  write("results/solved.vtu", "another result");
  const Project changed = opened();
  ASSERT_EQ(changed.notes.size(), 1u);
  EXPECT_NE(mesh_key(changed.study), mesh_key(saved.study));

  // Without it the parts open all the same: only a run needs it.
  fs::remove(folder / "results/solved.vtu");
  const Project without = opened();
  ASSERT_EQ(without.notes.size(), 1u);
  EXPECT_NE(without.notes[0].find("solved.vtu\" is missing"), std::string::npos);
  EXPECT_EQ(without.study.flow->field->source.sha256, flow.field->source.sha256);
  EXPECT_EQ(without.files.size(), 1u);

  // A project to hand on holds it.
  write("results/solved.vtu", "a result");
  saved.study.embed_inputs = true;
  ASSERT_TRUE(save_project(saved, file));
  fs::remove(folder / "results/solved.vtu");
  const Project handed = opened();
  ASSERT_EQ(handed.copies.count(flow.field->source.sha256), 1u);
  EXPECT_EQ(read_file(handed.copies.at(flow.field->source.sha256)).value(), "a result");
  ProjectContent again;
  again.study = handed.study;
  again.copies = handed.copies;
  ASSERT_TRUE(save_project(again, folder / "t.lamella"));
  const Result<Project> third = open_project(folder / "t.lamella");
  ASSERT_TRUE(third);
  EXPECT_EQ(third->copies.count(flow.field->source.sha256), 1u) << "copies are copied on";
}

TEST_F(ProjectFile, OnlyWhatWasReadIsCopied) {
  ProjectContent saved = content();
  saved.study.embed_inputs = true;
  write("parts/a.stl", "solid, changed meanwhile");
  const Result<Names> notes = save_project(saved, file);
  ASSERT_TRUE(notes);
  ASSERT_EQ(notes->size(), 1u);
  EXPECT_NE(notes->at(0).find("no longer what was read"), std::string::npos);
  EXPECT_EQ(Archive::open(file)->find("inputs/1-a.stl"), nullptr);
  write("copy", "solid a");
  saved.copies[saved.study.inputs[0].sha256] = folder / "copy";
  ASSERT_TRUE(save_project(saved, file)->empty());
  EXPECT_NE(Archive::open(file)->find("inputs/1-a.stl"), nullptr);
}

TEST_F(ProjectFile, ATextIsAStudyToo) {
  ProjectContent saved = content();
  const Result<Names> notes = save_project(saved, folder / "s.json");
  ASSERT_TRUE(notes);
  EXPECT_EQ(notes->size(), 1u) << "that the mesh is not in it";
  write("s.json.vtu", "of whom?");
  const Result<Project> text = open_project(folder / "s.json");
  ASSERT_TRUE(text) << text.error().message;
  EXPECT_EQ(study_to_json(text->study), study_to_json(saved.study));
  EXPECT_TRUE(text->mesh.empty());
  // Schema 1 had its mesh beside it, and no hashes.
  write("s.lamella", R"({"schema": 1, "inputs": ["parts/a.stl"], "bodies": [{"name": "a"}]})");
  write("s.lamella.vtu", "its mesh");
  const Project old = opened();
  EXPECT_EQ(old.mesh, file.string() + ".vtu");
  EXPECT_EQ(old.study.inputs[0].sha256, sha256("solid a"));
  EXPECT_EQ(mesh_key(*old.mesh_study), mesh_key(old.study));
  ProjectContent again;
  again.study = old.study;
  ASSERT_TRUE(save_project(again, file));
  EXPECT_NE(read_file(file.string() + ".bak")->find("\"schema\": 1"), std::string::npos);
  EXPECT_TRUE(opened().mesh.empty());
}

TEST_F(ProjectFile, HostileAndForeignFilesAreRefusedWithTheirCause) {
  const std::string study = study_to_json(Study{});
  const std::string copy = R"({"schema": 2, "inputs": [{"file": "a.stl", "entry": "inputs/1-a"}]})";
  const std::string deep(100000, '[');
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "neither a zip nor"},
      {"\x7f"
       "ELF and so on",
       "neither a zip nor"},
      {"{\"schema\": 3}", "newer version"},
      {deep, "nested too deep"},
      {std::string(33 << 20, ' ') + "{", "too long"},
      {"{" + std::string(33 << 20, ' '), "too long"},
      {copy, "which text cannot hold"},
      {raw_zip({{"other.json", "{}"}}), "no project.json"},
      {raw_zip({{"project.json", "{\"schema\": 7}"}}), "newer version (schema 7"},
      {raw_zip({{"project.json", deep}}), "nested too deep"},
      {raw_zip({{"project.json", "{\"schema\": 2, \"mesh\": 1}"}}), "\"mesh\" is not known"},
      {raw_zip({{"project.json", copy}}), "copy \"inputs/1-a\" of an input is missing"},
      {raw_zip({{"project.json", study}, {"mesh.vtu", "m"}, {"mesh.json", "{"}}), "JSON"},
      {raw_zip({{"project.json", study}, {"../mesh.vtu", "m"}}), "leaves the folder"}};
  for (const auto& [bytes, finding] : cases) {
    ASSERT_TRUE(write_file(file, bytes));
    const std::string told = refusal();
    EXPECT_NE(told.find(finding), std::string::npos) << finding << " in " << told;
    EXPECT_LT(told.size(), 500u);
  }
  EXPECT_EQ(folder.names(), Names{"s.lamella"});
  // A copy with another hash than the study's is no copy.
  const std::string swapped = R"({"schema": 2, "inputs": [{"file": "a.stl", "sha256": ")" +
                              sha256("solid a") + R"(", "bytes": 7, "entry": "inputs/1-a"}]})";
  ASSERT_TRUE(write_file(file, raw_zip({{"project.json", swapped}, {"inputs/1-a", "solid b"}})));
  EXPECT_NE(refusal().find("hash differs"), std::string::npos);
  // The link may try to leave, nothing is written there: a name of ours is used for the copy.
  const std::string climbing =
      R"({"schema": 2, "inputs": [{"file": "none/..", "entry": "inputs/1-a"}]})";
  ASSERT_TRUE(write_file(file, raw_zip({{"project.json", climbing}, {"inputs/1-a", "solid b"}})));
  (void)open_project(file);
  EXPECT_EQ(folder.names(), Names{"s.lamella"});
  EXPECT_EQ(open_project(folder / "none.lamella").error().code, Code::io);
  EXPECT_FALSE(open_project(folder.path()));
}

TEST_F(ProjectFile, OneBackupIsKeptOfWhatWasDifferent) {
  ASSERT_TRUE(save_project(content("first"), file));
  const std::string first = read_file(file).value();
  ASSERT_TRUE(save_project(content("first"), file));
  EXPECT_FALSE(fs::exists(file.string() + ".bak"));
  ASSERT_TRUE(save_project(content("second"), file));
  EXPECT_EQ(read_file(file.string() + ".bak").value(), first);
  ASSERT_TRUE(save_project(content("second"), file));
  EXPECT_EQ(read_file(file.string() + ".bak").value(), first);
  EXPECT_EQ(folder.names(), (Names{"parts", "s.lamella", "s.lamella.bak"}));
  EXPECT_EQ(read_file(opened().mesh).value(), "second");
}

TEST_F(ProjectFile, WhatCannotBeSavedChangesNothing) {
  ASSERT_TRUE(save_project(content(), file));
  const std::string before = read_file(file).value();
  ProjectContent failing = content();
  failing.write_mesh = [](const fs::path& vtu) -> Result<void> {
    EXPECT_TRUE(write_file(vtu, "half a mesh"));
    return Error{Code::io, "The disk is full.", ""};
  };
  EXPECT_EQ(save_project(failing, file).error().message, "The disk is full.");
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(save_project(content("other"), file, Progress({}, stop.get_token())).error().code,
            Code::cancelled);
  EXPECT_FALSE(save_project(content(), folder / "nowhere" / "s.lamella"));
  EXPECT_FALSE(save_project(content(), folder.path()));
  EXPECT_EQ(read_file(file).value(), before);
  EXPECT_EQ(folder.names(), (Names{"parts", "s.lamella"}));
}

TEST_F(ProjectFile, LeftoversOfTheDeadGoTheLivingKeepTheirs) {
  const std::string dead = ".s.lamella.999999999-0.part", deader = "." + dead + "x.part";
  const std::string alive = ".s.lamella." + std::to_string(::getpid()) + "-9.part";
  const std::string fresh = ".s.lamella.999999998-0.part", other = ".t.lamella.999999999-0.part";
  for (const std::string& name : {dead, deader, alive, fresh, other}) write(name, "x");
  const auto hour_ago = fs::file_time_type::clock::now() - std::chrono::hours(1);
  for (const std::string& name : {dead, deader, alive, other})
    fs::last_write_time(folder / name, hour_ago);
  ASSERT_TRUE(save_project(content(), file));
  Names expected{alive, fresh, other, "parts", "s.lamella"};
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(folder.names(), expected);
}

/// Whether the file is one of the two projects that were saved in turns, in full.
bool is_whole(const fs::path& file, const std::string& a, const std::string& b) {
  const Result<Project> project = open_project(file);
  if (!project) return false;
  const Result<std::string> mesh = read_file(project->mesh);
  return mesh && (*mesh == a || *mesh == b);
}

/// LAMELLA_KILLS sets the number of moments.
TEST_F(ProjectFile, KilledAtAnyMomentItIsOneOrTheOther) {
  const char* asked = std::getenv("LAMELLA_KILLS");
  const int kills = asked ? std::atoi(asked) : 60;
  const std::string a(100000, 'a'), b(200000, 'b');
  ASSERT_TRUE(save_project(content(a), file));
  std::mt19937 random(20);
  // Of three saves in a row, as long as they take here.
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  for (const std::string& mesh : {b, a, b}) ASSERT_TRUE(save_project(content(mesh), file));
  std::uniform_real_distribution<double> share(0, 1);
  const std::chrono::duration<double> three = Clock::now() - start;
  int lost = 0, replaced = 0;
  for (int k = 0; k < kills; ++k) {
    const auto before = fs::last_write_time(file);
    const pid_t child = ::fork();
    if (child == 0) {
      for (int turn = k;; ++turn) (void)save_project(content(turn % 2 ? a : b), file);
    }
    std::this_thread::sleep_for(three * share(random));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    lost += !is_whole(file, a, b) || !is_whole(file.string() + ".bak", a, b);
    replaced += fs::last_write_time(file) != before;
  }
  EXPECT_EQ(lost, 0);
  EXPECT_GT(replaced, 0) << "no child came to its first file";
  EXPECT_LT(replaced, kills) << "no child was killed within its first";
  std::printf("%d kills, %d of them after the first file was replaced, %d lost\n", kills, replaced,
              lost);
}

TEST_F(ProjectFile, OnAFullDiskTheOldOneStays) {
  ASSERT_TRUE(save_project(content("old"), file));
  const std::string before = read_file(file).value();
  std::string mesh;
  std::mt19937 random(3);
  while (mesh.size() < 50000) mesh.push_back(static_cast<char>(random()));
  ASSERT_TRUE(save_project(content(mesh), folder / "whole.lamella"));
  const auto whole = fs::file_size(folder / "whole.lamella");
  fs::remove(folder / "whole.lamella");
  const ProjectContent larger = content(mesh);
  for (int k = 0; k < 100; ++k) {
    const pid_t child = ::fork();
    if (child == 0) {
      ::signal(SIGXFSZ, SIG_IGN);
      const rlim_t most = (whole - 1) * static_cast<rlim_t>(k) / 99;
      const rlimit limit{most, most};
      ::setrlimit(RLIMIT_FSIZE, &limit);
      const Result<Names> saved = save_project(larger, file);
      ::_exit(saved ? 1 : saved.error().code == Code::io ? 0 : 2);
    }
    int status = -1;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 0) << "at limit " << k;
    ASSERT_EQ(read_file(file).value(), before) << "at limit " << k;
  }
  EXPECT_EQ(folder.names(), (Names{"parts", "s.lamella"}));
}

TEST_F(ProjectFile, TellsWhereFacesWereOnceTheCadHasChanged) {
  // A flat part of two faces, which change their numbers.
  Part part;
  part.name = "a";
  part.surface.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 0, 0}, {9, 1, 0}, {8, 0, 0}};
  part.surface.facets = {{0, 1, 2}, {3, 4, 5}};
  part.surface.facet_face = {0, 1};
  part.surface.faces.resize(2);
  ProjectContent saved = content();
  saved.study.groups = {{"gate", GroupKind::gate, "a", {1}}};
  saved.faces = known_faces(saved.study, {part});
  ASSERT_EQ(saved.faces.size(), 1u);
  ASSERT_TRUE(save_project(saved, file));

  Project same = opened();
  EXPECT_EQ(fit_to_parts(same.study, file, {part}), Names{});
  EXPECT_EQ(same.study.groups[0].faces, std::vector<std::int32_t>{1});

  write("parts/a.stl", "solid b");
  std::swap(part.surface.facets[0], part.surface.facets[1]);
  Project changed = opened();
  EXPECT_EQ(fit_to_parts(changed.study, file, {part}).size(), 1u) << "it is told";
  EXPECT_EQ(changed.study.groups[0].faces, std::vector<std::int32_t>{0});

  // Projects of earlier versions do not tell: the numbers stay, and that is said.
  saved.faces.clear();
  saved.study.inputs[0].sha256 = std::string(64, '0');
  ASSERT_TRUE(save_project(saved, file));
  Project silent = opened();
  EXPECT_EQ(fit_to_parts(silent.study, file, {part}).size(), 1u);
  EXPECT_EQ(silent.study.groups[0].faces, std::vector<std::int32_t>{1});
}

TEST(KnownFaces, AreNotReadFromAnythingElse) {
  for (const char* json :
       {"", "{}", "[1]", R"([{"part":"a"}])", R"([{"part":"a","diagonal":1,"faces":[[1,2]]}])",
        R"([{"part":"a","diagonal":1,"faces":[[1,2,3,4,5,6,"7"]]}])"})
    EXPECT_FALSE(known_faces_from(json)) << json;
}

TEST(Unmatched, NamesWhatThePartsDoNotHave) {
  Part part;
  part.name = "lid";
  part.surface.faces = {{"top"}, {""}};
  Study study;
  study.bodies = {{"lid"}, {"box"}, {"zone"}};
  study.zones.resize(1);
  study.zones[0].name = "zone";
  study.groups = {{"gate", GroupKind::gate, "lid", {1}, {"top"}},
                  {"vent", GroupKind::vent, "", {2}, {"bottom"}},
                  {"rest", GroupKind::other, "box", {0}}};
  study.sizing = {{"all", "", WholeBody{}, SizeCorrection{}},
                  {"fine", "rib", WholeBody{}, SizeCorrection{}}};
  const Names notes = unmatched(study, {part});
  ASSERT_EQ(notes.size(), 5u);
  EXPECT_NE(notes[0].find("no body \"box\""), std::string::npos);
  EXPECT_NE(notes[1].find("no face 2"), std::string::npos);
  EXPECT_NE(notes[2].find("no face \"bottom\""), std::string::npos);
  EXPECT_NE(notes[3].find("\"rest\" is on the body \"box\""), std::string::npos);
  EXPECT_NE(notes[4].find("\"fine\" is on the body \"rib\""), std::string::npos);
}

}  // namespace
}  // namespace lamella
