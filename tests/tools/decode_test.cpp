#include "tools/commands/decode.hpp"

#include <algorithm>
#include <condition_variable>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mutex>
#include <sstream>
#include <streambuf>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bus/vehicle_bus.hpp"
#include "can/candump_log.hpp"

namespace {

using testing::EndsWith;
using testing::HasSubstr;

struct Result {
  int status = 0;
  std::string out;
  std::string err;
};

Result Decode(const std::string& text) {
  std::istringstream in(text);
  std::ostringstream out;
  std::ostringstream err;
  const int status = tools::RunDecode(in, "drive.log", out, err);
  return {status, out.str(), err.str()};
}

std::string ReadFile(const std::string& name) {
  std::ifstream file(std::string(LPVMPC_SOURCE_DIR "/tests/golden/") + name);
  EXPECT_TRUE(file.is_open()) << name;
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string Line(const bus::Message& message, std::uint8_t counter, const std::string& interface = "vcan0") {
  static const bus::VehicleBus kBus;
  bus::RawMessage raw;
  EXPECT_NE(kBus.Encode(message, counter, raw), dbc::EncodeStatus::kNotFinite);
  can::Frame frame;
  frame.id = raw.id;
  frame.length = raw.length;
  std::ranges::copy(raw.data, frame.data.begin());
  return can::FormatCandumpLine(frame, interface) + "\n";
}

TEST(Decode, GoldenLogGivesItsText) {
  const Result result = Decode(ReadFile("decode.log"));
  EXPECT_EQ(result.out, ReadFile("decode.txt"));
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(result.status, 0);
}

TEST(Decode, ShowsPhysicalValuesWithUnitsAndTextsOfEnumerations) {
  EXPECT_EQ(Decode(Line(bus::VehiclePose{.X = 12.0, .Y = -3.5}, 7)).out,
            "(0000000000.000000) vcan0 VehiclePose X=12.0000 m Y=-3.5000 m | crc ok, counter 7 first\n");
  EXPECT_THAT(
      Decode(Line(bus::SteeringCommand{.enable = true, .mode = bus::Mode::kSafeStop, .delta = -0.000002}, 0))
          .out,
      HasSubstr("Enable=1 Mode=SafeStop PlanAge=0 Delta=-0.000002 rad |"));
}

TEST(Decode, MultiplexedFrameShowsOnlyItsOwnSignals) {
  const std::string line = Decode(Line(bus::ObstacleMotion{.object_id = 2, .velocity_X = 1.5}, 0)).out;
  EXPECT_THAT(line,
              HasSubstr("Part=Motion ObjectId=2 VelocityX=1.500 m/s VelocityY=0.000 m/s Class=Unknown |"));
}

TEST(Decode, JudgesTheCounterOfEachMessageAndInterfaceByItself) {
  const bus::ObstacleList list;
  const bus::DriverRequest request;
  const std::string out =
      Decode(Line(list, 13) + Line(request, 2) + Line(list, 14) + Line(list, 0) + Line(list, 0) +
             Line(list, 4) + Line(request, 3) + Line(list, 5, "vcan1") + Line(list, 3))
          .out;
  std::vector<std::string> verdicts;
  std::istringstream lines(out);
  for (std::string line; std::getline(lines, line);) verdicts.push_back(line.substr(line.find("counter")));
  EXPECT_THAT(verdicts, testing::ElementsAre("counter 13 first", "counter 2 first", "counter 14 ok",
                                             "counter 0 ok", "counter 0 repeated", "counter 4 lost 3",
                                             "counter 3 ok", "counter 5 first", "counter 3 lost 13"));
}

TEST(Decode, BadCrcIsReportedAndItsCounterIsNotBelieved) {
  std::string bad = Line(bus::ObstacleList{}, 9);
  const std::size_t payload = bad.find('#') + 1;
  bad[payload] = bad[payload] == '0' ? '1' : '0';
  const std::string out = Decode(Line(bus::ObstacleList{}, 1) + bad + Line(bus::ObstacleList{}, 2)).out;
  EXPECT_THAT(out, HasSubstr("| crc BAD, counter 9 not judged\n"));
  EXPECT_THAT(out, EndsWith("| crc ok, counter 2 ok\n"));
}

TEST(Decode, FramesThatAreNotOursAreShownAsTheyCame) {
  EXPECT_EQ(Decode("(0000000001.000000) vcan0 7FF#0102\n").out,
            "(0000000001.000000) vcan0 7FF#0102 | unknown id\n");
  // The id of VehiclePose, but extended.
  EXPECT_EQ(Decode("(0000000001.000000) vcan0 00000100#0102030405060708\n").out,
            "(0000000001.000000) vcan0 00000100#0102030405060708 | unknown id\n");
  EXPECT_THAT(Decode("(0000000001.000000) vcan0 100#0102\n").out,
              EndsWith("100#0102 | VehiclePose, but of 2 bytes, expected 8\n"));
  EXPECT_THAT(Decode("(0000000001.000000) vcan0 100#R8\n").out,
              EndsWith("100#R8 | VehiclePose, but a remote frame\n"));
  EXPECT_THAT(Decode("(0000000001.000000) vcan0 100##00102030405060708\n").out,
              EndsWith("| VehiclePose, but an FD frame\n"));
  EXPECT_THAT(Decode("(0000000001.000000) vcan0 20000004#0004000000000000\n").out,
              EndsWith("| error frame\n"));
}

TEST(Decode, MalformedLineIsAnErrorWithItsPlaceAndTheRestIsStillDecoded) {
  const Result result =
      Decode("# a comment\n\n" + Line(bus::ObstacleList{}, 1) + "nonsense\n" + Line(bus::ObstacleList{}, 2));
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.err, testing::StartsWith("drive.log:4: "));
  EXPECT_EQ(std::ranges::count(result.err, '\n'), 1);
  EXPECT_THAT(result.out, EndsWith("counter 2 ok\n"));
}

TEST(Decode, InputThatCannotBeReadAndOutputThatCannotBeWrittenFail) {
  std::ifstream folder("/");
  std::ostringstream out;
  std::ostringstream err;
  EXPECT_EQ(tools::RunDecode(folder, "/", out, err), 1);
  EXPECT_THAT(err.str(), HasSubstr("/: cannot be read"));

  std::istringstream in(Line(bus::ObstacleList{}, 1));
  std::ofstream full("/dev/full");
  err.str("");
  EXPECT_EQ(tools::RunDecode(in, "a.log", full, err), 1);
  EXPECT_THAT(err.str(), HasSubstr("output"));
}

// A stream whose reader waits for text from another thread, like a pipe.
class Pipe : public std::streambuf {
 public:
  void Write(const std::string& text) {
    const std::lock_guard lock(mutex_);
    waiting_ += text;
    changed_.notify_all();
  }
  void Close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

 protected:
  int_type underflow() override {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return closed_ || !waiting_.empty(); });
    if (waiting_.empty()) return traits_type::eof();
    current_ = std::exchange(waiting_, {});
    setg(current_.data(), current_.data(), current_.data() + current_.size());
    return traits_type::to_int_type(*gptr());
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::string waiting_;
  std::string current_;
  bool closed_ = false;
};

// Lets a test wait until text is flushed to it.
class FlushedText : public std::stringbuf {
 public:
  std::string Wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !flushed_.empty(); });
    return std::exchange(flushed_, {});
  }

 protected:
  int sync() override {
    const std::lock_guard lock(mutex_);
    flushed_ += str();
    str("");
    changed_.notify_all();
    return 0;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::string flushed_;
};

TEST(Decode, LiveFrameIsWrittenOutBeforeTheNextOneComes) {
  Pipe pipe;
  FlushedText text;
  std::jthread decoder([&] {
    std::istream in(&pipe);
    std::ostream out(&text);
    std::ostringstream err;
    EXPECT_EQ(tools::RunDecode(in, "-", out, err), 0);
  });
  for (std::uint8_t counter = 0; counter < 3; ++counter) {
    pipe.Write(Line(bus::ObstacleList{.count = counter}, counter));
    EXPECT_THAT(text.Wait(), HasSubstr("ObstacleList Count=" + std::to_string(counter)));
  }
  pipe.Close();
}

}  // namespace
