#include "backends/process/conversation.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "backends/interface/backend.h"
#include "platform/process.h"
#include "tests/support/files_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

using Cause = ConversationFailure::Cause;

/// The program's end of the socket.
class Caller {
 public:
  explicit Caller(const std::filesystem::path& socket)
      : connection_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::ranges::copy(socket.native(), std::begin(address.sun_path));
    connected_ =
        ::connect(connection_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  bool is_connected() const { return connected_; }
  void send(std::string_view text) const {
    EXPECT_EQ(::send(connection_.get(), text.data(), text.size(), MSG_NOSIGNAL), std::ssize(text));
  }
  std::string line() const {
    std::string text;
    for (char c = 0; ::read(connection_.get(), &c, 1) == 1 && c != '\n';) text += c;
    return text;
  }

 private:
  Descriptor connection_;
  bool connected_ = false;
};

class ConversationTest : public TemporaryFolderTest {
 protected:
  /// Has a thread connect and do something, then talks with it.
  void talk(const std::function<void(const Caller&)>& program, const std::function<void()>& ours,
            double time_limit_s = 20) {
    std::jthread other([&] {
      const Caller caller(conversation_.socket());
      ASSERT_TRUE(caller.is_connected());
      program(caller);
    });
    conversation_.begin(std::chrono::duration<double>(time_limit_s), -1);
    ours();
  }

  /// Expects that asking a program for a step fails for that cause with this in the sentence.
  void expect_failure(Cause cause, const std::string& text, const std::function<void(const Caller&)>& program,
                      double time_limit_s = 20) {
    const auto ask = [&] {
      try {
        conversation_.ask("step 10\n", "step 10");
        conversation_.answer();
        ADD_FAILURE() << "it did not fail";
      } catch (const ConversationFailure& failure) {
        EXPECT_EQ(failure.cause, cause);
        EXPECT_THAT(failure.what(), HasSubstr(text));
        conversation_.say_last("end\n");  // lets the thread end
      }
    };
    talk(program, ask, time_limit_s);
  }
  /// Takes the request and says nothing until the end.
  static void stay_silent(const Caller& program) {
    program.line();
    program.line();
  }

  Conversation conversation_{folder()};
};

TEST_F(ConversationTest, CarriesLinesBothWays) {
  talk(
      [](const Caller& program) {
        EXPECT_EQ(program.line(), "hello");
        EXPECT_EQ(program.line(), "prepare");
        program.send("note one");
        program.send(" and two\nready 1\n");
        EXPECT_EQ(program.line(), "end");
      },
      [&] {
        conversation_.ask("hello\nprepare\n", "prepare");
        EXPECT_EQ(conversation_.answer(), "note one and two");
        EXPECT_EQ(conversation_.answer(), "ready 1");
        conversation_.say_last("end\n");
      });
}

TEST_F(ConversationTest, TellsOfSilence) {
  expect_failure(Cause::silence, "did not answer \"step 10\" within 0.2 s", stay_silent, 0.2);
}

TEST_F(ConversationTest, TakesAnAnswerThatComesByteByByteForSilenceOnceItsTimeIsOver) {
  const auto byte_by_byte = [](const Caller& program) {
    program.line();
    // More often than a wait looks at the clock, and far longer than the limit.
    for (int i = 0; i < 60; ++i, std::this_thread::sleep_for(std::chrono::milliseconds(50)))
      program.send(".");
    program.send("\n");
    program.line();
  };
  expect_failure(Cause::silence, "did not answer", byte_by_byte, 0.2);
}

TEST_F(ConversationTest, ListensAtAShortNameWhereTheFolderHasALongOne) {
  const std::filesystem::path deep = folder() / std::string(120, 'x');
  create_directory(deep);
  std::filesystem::path socket;
  {
    const Conversation conversation(deep);
    socket = conversation.socket();
    EXPECT_TRUE(Caller(socket).is_connected());
  }
  EXPECT_FALSE(exists(socket.parent_path()));
}

TEST_F(ConversationTest, TellsOfAProgramThatNeverConnects) {
  try {
    conversation_.begin(std::chrono::duration<double>(0.2), -1);
    FAIL() << "it connected";
  } catch (const ConversationFailure& failure) {
    EXPECT_EQ(failure.cause, Cause::silence);
    EXPECT_STREQ(failure.what(), "did not connect to MSSIM_SOCKET within 0.2 s");
  }
}

TEST_F(ConversationTest, TellsOfAClosedConnection) {
  expect_failure(Cause::closed, "before it answered \"step 10\"",
                 [](const Caller& program) { program.line(); });
}

TEST_F(ConversationTest, RefusesLinesWithoutEnd) {
  expect_failure(Cause::answer, "answered \"step 10\" with a line of more than 4096 bytes",
                 [](const Caller& program) {
                   program.line();
                   program.send(std::string(4096, 'x'));
                   program.line();
                 });
}

TEST_F(ConversationTest, TakesTheLongestLine) {
  talk(
      [](const Caller& program) {
        program.line();
        program.send(std::string(4095, 'x') + '\n');
      },
      [&] {
        conversation_.ask("step 1\n", "step 1");
        EXPECT_EQ(conversation_.answer(), std::string(4095, 'x'));
      });
}

TEST_F(ConversationTest, RefusesWhatWasNotAskedFor) {
  talk(
      [](const Caller& program) {
        program.line();
        program.send("done\ndone\n");
        program.line();
      },
      [&] {
        conversation_.ask("set\n", "set");
        EXPECT_EQ(conversation_.answer(), "done");
        try {
          conversation_.ask("step 10\n", "step 10");
          ADD_FAILURE() << "the second answer was not noticed";
        } catch (const ConversationFailure& failure) {
          EXPECT_EQ(failure.cause, Cause::answer);
          EXPECT_STREQ(failure.what(),
                       "sent \"done\" after its answer to \"set\", although nothing was requested");
        }
        conversation_.say_last("end\n");
      });
}

TEST_F(ConversationTest, RefusesASecondConnection) {
  expect_failure(Cause::answer, "connected a second time before it answered \"step 10\"",
                 [&](const Caller& program) {
                   const Caller second(conversation_.socket());
                   stay_silent(program);
                 });
}

TEST_F(ConversationTest, EndsAWaitWhenTheUserEndsMssim) {
  const auto before = std::chrono::steady_clock::now();
  talk(
      [](const Caller& program) {
        program.line();
        note_ending_signal(SIGTERM);
        program.line();
      },
      [&] {
        conversation_.ask("step 1\n", "step 1");
        try {
          conversation_.answer();
          ADD_FAILURE() << "there was an answer";
        } catch (const Interrupted& interrupted) {
          EXPECT_EQ(interrupted.signal, SIGTERM);
        }
        conversation_.say_last("end\n");
      });
  EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(10));
  EXPECT_EQ(noted_ending_signal(), 0);
}

/// What taking this answer to `costs` fails with.
std::string complaint_about_cost(const std::string& line) {
  Communication costs;
  return sentence_of<ConversationFailure>([&] { take_cost(costs, line); });
}

TEST(Answers, SayWhatAProgramIs) {
  Introduction introduction;
  for (const char* line : {"device a chip", "threads 3", "pass 4", "precision single", "note first",
                           "note second", "untimed too crowded", "tells costs"})
    EXPECT_FALSE(take_introduction(introduction, line)) << line;
  EXPECT_TRUE(take_introduction(introduction, "ready 1"));
  EXPECT_EQ(introduction.device, "a chip");
  EXPECT_EQ(introduction.threads, 3);
  EXPECT_EQ(introduction.steps_per_pass, 4);
  EXPECT_EQ(introduction.note, "single precision; first; second");
  EXPECT_TRUE(introduction.is_in_single);
  EXPECT_EQ(introduction.untimed, "too crowded");
  EXPECT_TRUE(introduction.tells_costs);
  EXPECT_FALSE(take_introduction(introduction, "precision double"));
  EXPECT_FALSE(introduction.is_in_single);
}

TEST(Answers, RefuseAProgramOrItsScene) {
  Introduction introduction;
  EXPECT_THROW(take_introduction(introduction, "unsupported red springs"), Unsupported);
  EXPECT_THROW(take_introduction(introduction, "unavailable no chip"), Unavailable);
  EXPECT_THROW(take_introduction(introduction, "failed no licence"), ConversationFailure);
  for (const char* line :
       {"", "ready 2", "threads 0", "threads 5000", "pass 0", "pass 1001", "tells", "tells jokes", "device"})
    EXPECT_THROW(take_introduction(introduction, line), ConversationFailure) << line;
  for (const char* word : {"unsupported", "unavailable", "failed"})
    for (const std::string& line : {std::string(word), word + std::string(" ")})
      EXPECT_THAT(sentence_of<ConversationFailure>([&] { take_introduction(introduction, line); }),
                  AllOf(StartsWith("answered \"" + line), HasSubstr("reason")))
          << line;
}

TEST(Answers, SayWhatProcessesSpendOnEachOther) {
  Communication costs;
  for (const char* line : {"cost waiting 0.125", "cost packing 0.5", "cost bytes 4800", "cost messages 2"})
    EXPECT_FALSE(take_cost(costs, line)) << line;
  EXPECT_EQ(costs.latency_s, std::nullopt);
  EXPECT_FALSE(take_cost(costs, "cost latency 1e-6"));
  EXPECT_FALSE(take_cost(costs, "cost bandwidth 5e9"));
  EXPECT_TRUE(take_cost(costs, "done"));
  EXPECT_EQ(costs.waiting, 0.125);
  EXPECT_EQ(costs.packing, 0.5);
  EXPECT_EQ(costs.bytes, 4800);
  EXPECT_EQ(costs.messages, 2);
  EXPECT_EQ(costs.latency_s, 1e-6);
  EXPECT_EQ(costs.bytes_per_second, 5e9);
}

TEST(Answers, RefuseCostsThatCannotBe) {
  for (const char* line : {"cost waiting 1.5", "cost waiting -0.1", "cost bytes nan", "cost bytes inf",
                           "cost bytes", "cost joules 3", "price bytes 3", "done 0.5", "cost bytes 3 4"})
    EXPECT_THAT(complaint_about_cost(line), HasSubstr("where cost waiting")) << line;
  EXPECT_EQ(complaint_about_cost("failed the meter is broken"), "failed at \"costs\": the meter is broken");
}

TEST(Answers, SayThatARequestIsDone) {
  EXPECT_NO_THROW(take_done("get", "done", false));
  EXPECT_NO_THROW(take_done("step 3", "done 0.25", true));
  for (const char* line : {"done 0.25", "ready 1", "", "failed"})
    EXPECT_THROW(take_done("get", line, false), ConversationFailure) << line;
  EXPECT_THROW(take_done("step 3", "done -1", true), ConversationFailure);
  EXPECT_THAT(sentence_of<ConversationFailure>([] { take_done("step 3", "hello", true); }),
              StartsWith("answered \"hello\" to \"step 3\""));
}

}  // namespace
}  // namespace mssim
