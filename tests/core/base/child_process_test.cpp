#include "core/base/child_process.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "core/base/parallel.h"

namespace lamella {
namespace {

constexpr double kLong = 60;

void expect_no_child_left() {
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

Error error_of(const std::function<std::string()>& work, double limit = kLong,
               const Progress& progress = {}) {
  const auto result = run_in_child([&](const Progress&) { return work(); }, {limit}, progress);
  expect_no_child_left();
  EXPECT_FALSE(result.ok());
  return result.ok() ? Error{} : result.error();
}

TEST(ChildProcess, HandsBackEveryByte) {
  std::string bytes(3'000'000, '\0');  // many times what a pipe holds
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 7 + i / 251);
  const auto result = run_in_child([&](const Progress&) { return bytes; }, {kLong}, {});
  ASSERT_TRUE(result.ok()) << result.error().message;
  EXPECT_EQ(*result, bytes);
  expect_no_child_left();
  const auto nothing = run_in_child([](const Progress&) { return std::string(); }, {kLong}, {});
  ASSERT_TRUE(nothing.ok());
  EXPECT_EQ(*nothing, "");
}

TEST(ChildProcess, WorksOnACopy) {
  int here = 1;
  const auto result =
      run_in_child([&](const Progress&) { return std::to_string(++here); }, {kLong}, {});
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(*result, "2");
  EXPECT_EQ(here, 1);
}

TEST(ChildProcess, TurnsACrashIntoASentence) {
  for (const int signal : {SIGSEGV, SIGFPE, SIGABRT, SIGBUS, SIGILL}) {
    const Error error = error_of([&]() -> std::string {
      ::raise(signal);
      return "not reached";
    });
    EXPECT_EQ(error.code, Code::failed);
    EXPECT_EQ(error.message, std::string("it crashed (") + ::sigdescr_np(signal) + ").");
  }
}

TEST(ChildProcess, TurnsAnExitIntoASentence) {
  const Error error = error_of([]() -> std::string { ::_exit(7); });
  EXPECT_EQ(error.code, Code::failed);
  EXPECT_EQ(error.message, "it ended early (exit code 7).");
  EXPECT_EQ(error_of([]() -> std::string { ::_exit(0); }).code, Code::failed);
}

TEST(ChildProcess, TurnsExceptionsIntoSentences) {
  const Error error = error_of([]() -> std::string { throw std::runtime_error("no luck"); });
  EXPECT_EQ(error.code, Code::failed);
  EXPECT_EQ(error.message, "no luck");
  EXPECT_EQ(error_of([]() -> std::string { throw 5; }).code, Code::failed);
  EXPECT_EQ(error_of([]() -> std::string { throw std::bad_alloc(); }).code, Code::memory);
}

TEST(ChildProcess, NamesMemoryWhenTheSystemKillsIt) {
  const Error error = error_of([]() -> std::string {
    ::raise(SIGKILL);
    return "";
  });
  EXPECT_EQ(error.code, Code::memory);
}

TEST(ChildProcess, EndsWhatTakesTooLong) {
  const auto start = std::chrono::steady_clock::now();
  const Error error = error_of(
      []() -> std::string {
        for (;;) ::pause();
      },
      0.2);
  EXPECT_EQ(error.code, Code::failed);
  EXPECT_EQ(error.message, "it found no end within 0.2 s.");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST(ChildProcess, KillsOnCancel) {
  std::stop_source stop;
  const auto start = std::chrono::steady_clock::now();
  const std::jthread user([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    stop.request_stop();
  });
  const Error error = error_of(
      []() -> std::string {
        for (;;) ::pause();
      },
      kLong, Progress({}, stop.get_token()));
  EXPECT_EQ(error.code, Code::cancelled);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST(ChildProcess, EndsWhatTakesTooMuchMemory) {
  const auto work = [](const Progress&) {
    return std::string(1, std::string(60'000'000, 'x').back());
  };
  const auto refused = run_in_child(work, {.seconds = kLong, .bytes = 30'000'000}, {});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, Code::memory);
  EXPECT_TRUE(run_in_child(work, {.seconds = kLong, .bytes = 120'000'000}, {}).ok());
  // What the caller has itself does not count.
  const std::string much(200'000'000, 'y');
  EXPECT_TRUE(run_in_child(work, {.seconds = kLong, .bytes = 120'000'000}, {}).ok());
  EXPECT_EQ(much.size(), 200'000'000u);
}

TEST(ChildProcess, PassesProgressOn) {
  std::vector<std::pair<double, std::string>> told;
  const Progress progress([&](double fraction, std::string_view phase) {
    told.emplace_back(fraction, std::string(phase));
  });
  const auto result = run_in_child(
      [](const Progress& through) {
        through.portion(0, 0.5, "first").report(0.5);
        through.portion(0.5, 1, "second").report(1);
        return std::string("pv");  // an answer may begin like a message
      },
      {kLong}, progress.portion(0, 0.5, "outer"));
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(*result, "pv");
  const std::vector<std::pair<double, std::string>> expected = {{0.125, "first"}, {0.5, "second"}};
  EXPECT_EQ(told, expected);
}

TEST(ChildProcess, WorksInPlaceInParallelLoops) {
  std::vector<int> squares(1000);
  const auto square = [&](std::size_t i) { squares[i] = static_cast<int>(i * i); };
  parallel_each(squares.size(), 0, {}, square);  // the pool has its threads now
  const auto result = run_in_child(
      [&](const Progress& through) {
        squares.assign(squares.size(), 0);
        parallel_each(squares.size(), 0, through, square);
        std::string bytes;
        for (const int s : squares) bytes += std::to_string(s) + " ";
        return bytes;
      },
      {kLong}, {});
  std::string expected;
  for (const int s : squares) expected += std::to_string(s) + " ";
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(*result, expected);
}

TEST(ChildProcess, LosesWhatIsPrinted) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const auto result = run_in_child(
      [](const Progress&) {
        std::printf("noise");
        std::fprintf(stderr, "noise");
        std::fflush(nullptr);
        return std::string("done");
      },
      {kLong}, {});
  EXPECT_TRUE(result.ok());
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace lamella
