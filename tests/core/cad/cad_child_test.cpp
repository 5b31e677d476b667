#include "core/cad/cad_child.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "core/base/parallel.h"
#include "core/cad/occt_guard.h"
#include "core/cad/sample_parts.h"
#include "tests/support/temporary_folder.h"

namespace lamella {
namespace {

const std::filesystem::path kReal = LAMELLA_REAL_PARTS;

template <class T>
void expect_same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_TRUE(a.empty() ||
              std::memcmp(static_cast<const void*>(a.data()), static_cast<const void*>(b.data()),
                          a.size() * sizeof(T)) == 0);
}

void expect_same(const CadContent& a, const CadContent& b) {
  EXPECT_EQ(a.free_shells, b.free_shells);
  EXPECT_EQ(a.free_faces, b.free_faces);
  ASSERT_EQ(a.bodies.size(), b.bodies.size());
  for (std::size_t k = 0; k < a.bodies.size(); ++k) {
    const CadBody &x = a.bodies[k], &y = b.bodies[k];
    EXPECT_EQ(x.part.name, y.part.name);
    EXPECT_EQ(x.part.color, y.part.color);
    EXPECT_EQ(x.part.cad_volume, y.part.cad_volume);
    EXPECT_EQ(x.part.chord_error, y.part.chord_error);
    EXPECT_EQ(x.part.notes, y.part.notes);
    const ReferenceSurface<3>&s = x.part.surface, &t = y.part.surface;
    expect_same_bits(s.points, t.points);
    expect_same_bits(s.facets, t.facets);
    expect_same_bits(s.facet_face, t.facet_face);
    expect_same_bits(s.feature_edges, t.feature_edges);
    expect_same_bits(s.corners, t.corners);
    ASSERT_EQ(s.faces.size(), t.faces.size());
    for (std::size_t f = 0; f < s.faces.size(); ++f) {
      EXPECT_EQ(s.faces[f].name, t.faces[f].name);
      EXPECT_EQ(s.faces[f].color, t.faces[f].color);
    }
    ASSERT_EQ(x.refusal.has_value(), y.refusal.has_value());
    if (x.refusal) {
      EXPECT_EQ(x.refusal->code, y.refusal->code);
      EXPECT_EQ(x.refusal->message, y.refusal->message);
      EXPECT_EQ(x.refusal->hint, y.refusal->hint);
    }
    expect_same_bits(x.rough.points, y.rough.points);
    expect_same_bits(x.rough.facets, y.rough.facets);
    EXPECT_EQ(x.exact_shape_valid, y.exact_shape_valid);
  }
}

std::filesystem::path sample(const test::TemporaryFolder& folder, const std::string& name) {
  const auto file = folder / (name + ".step");
  EXPECT_TRUE(write_sample(name, file).ok());
  return file;
}

void expect_read_alike(const std::filesystem::path& file) {
  CadContent direct, apart;
  const Result<void> one = guarded("file", [&] { return read_cad(file, {}, {}, direct); });
  const Result<void> two = read_cad_in_child(file, {}, {}, apart);
  ASSERT_TRUE(one.ok() && two.ok()) << (one ? two : one).error().message;
  EXPECT_GT(direct.bodies.size(), 0u);
  expect_same(direct, apart);
}

TEST(CadChild, ReadsWhatIsReadDirectlyBitByBit) {
  const test::TemporaryFolder folder;
  for (const std::string& name : sample_names()) expect_read_alike(sample(folder, name));
}

TEST(CadChild, ReadsRealPartsAlike) {
  for (const char* name : {"prusa_mini_fsensor_cover.stp", "jst_xh_s4b_header.step"}) {
    if (!std::filesystem::exists(kReal / name)) GTEST_SKIP() << "missing " << kReal / name;
    expect_read_alike(kReal / name);
  }
}

TEST(CadChild, HandsBackRefusalsAndErrors) {
  CadContent content, back;
  content.free_faces = 3;
  CadBody& body = content.bodies.emplace_back();
  body.part.name = "lid";
  body.part.notes = {"", "a note"};
  body.refusal = Error{Code::bad_input, "open", "close it"};
  body.rough = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  body.exact_shape_valid = false;
  const Error error{Code::io, "a sentence", "a hint"};
  const std::string bytes = to_bytes(content, error);
  Result<void> outcome;
  ASSERT_TRUE(from_bytes(bytes, back, outcome));
  expect_same(content, back);
  ASSERT_FALSE(outcome.ok());
  EXPECT_EQ(outcome.error().code, Code::io);
  EXPECT_EQ(outcome.error().message, "a sentence");
  EXPECT_EQ(outcome.error().hint, "a hint");

  for (std::size_t n = 0; n < bytes.size(); ++n) {
    CadContent cut;
    EXPECT_FALSE(from_bytes(bytes.substr(0, n), cut, outcome)) << n;
  }
  body.rough.facets[0][1] = 3;  // no such point
  EXPECT_FALSE(from_bytes(to_bytes(content, {}), back, outcome));
}

Error error_of(const CadWork& work, const LoadParams& params = {}, const Progress& progress = {}) {
  CadContent content;
  const Result<void> result = read_cad_in_child("part.step", params, progress, content, work);
  EXPECT_FALSE(result.ok());
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
  if (result.ok()) return {};
  if (result.error().code != Code::cancelled) {
    EXPECT_EQ(result.error().message.substr(0, 11), "part.step: ");
    EXPECT_FALSE(result.error().hint.empty());
  }
  return result.error();
}

TEST(CadChild, SurvivesACrash) {
  const Error error = error_of([](const auto&, const auto&, const auto&, auto&) -> Result<void> {
    ::signal(SIGSEGV, SIG_DFL);
    ::raise(SIGSEGV);
    return {};
  });
  EXPECT_EQ(error.code, Code::failed);
  EXPECT_NE(error.message.find("it crashed"), std::string::npos) << error.message;
}

TEST(CadChild, EndsAHang) {
  const Error error = error_of(
      [](const auto&, const auto&, const auto&, auto&) -> Result<void> {
        for (;;) ::pause();
      },
      {.cad_seconds = 0.2});
  EXPECT_EQ(error.code, Code::failed);
  EXPECT_NE(error.message.find("no end within 0.2 s"), std::string::npos) << error.message;
}

TEST(CadChild, BoundsMemory) {
  const CadWork hungry = [](const auto&, const auto&, const auto&, auto& content) -> Result<void> {
    content.bodies.emplace_back().rough.points.assign(4'000'000, Vec<3>::Ones());  // 96 MB
    content.bodies.clear();
    return {};
  };
  EXPECT_EQ(error_of(hungry, {.cad_memory = 50}).code, Code::memory);
  CadContent content;
  EXPECT_TRUE(read_cad_in_child("part.step", {.cad_memory = 300}, {}, content, hungry).ok());
}

TEST(CadChild, CancelEndsIt) {
  std::stop_source stop;
  std::atomic<double> told = 0;
  // The child's report reaches the caller, who then cancels.
  const Progress progress(
      [&](double fraction, std::string_view phase) {
        EXPECT_EQ(phase, "Reading");
        told = fraction;
        stop.request_stop();
      },
      stop.get_token());
  const Error error = error_of(
      [](const auto&, const auto&, const Progress& through, auto&) -> Result<void> {
        through.portion(0, 1, "Reading").report(0.5);
        for (;;) ::pause();
      },
      {}, progress);
  EXPECT_EQ(error.code, Code::cancelled);
  EXPECT_EQ(told.load(), 0.5);
}

// Threads of a pool do not come along into a copy of the process.
TEST(CadChild, WorksBesideBusyThreads) {
  const test::TemporaryFolder folder;
  const auto file = sample(folder, sample_names().front());
  std::atomic<bool> end = false;
  std::jthread busy([&] {
    while (!end) parallel_each(10'000, 0, {}, [](std::size_t) { ::getpid(); });
  });
  for (int k = 0; k < 10; ++k) {
    CadContent content;
    const Result<void> result = read_cad_in_child(file, {.cad_seconds = 60}, {}, content);
    EXPECT_TRUE(result.ok()) << result.error().message;
  }
  end = true;
}

}  // namespace
}  // namespace lamella
