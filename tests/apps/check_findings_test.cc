// What `check` says of how the frames came.

#include "check_findings.h"

#include <gtest/gtest.h>

#include "lead_counter.h"

namespace stereomotion::app {
namespace {

// Two cameras at 50 Hz for two seconds, in step.
StreamFacts GoodStream() {
  StreamFacts stream;
  stream.names = {"cam0", "cam1"};
  stream.live = true;
  stream.frames = {100, 100};
  stream.pairs = 100;
  stream.watched_s = 2;
  stream.rate_hz = {50, 50};
  stream.period_s = 0.02;
  stream.jitter_ms = 0.01;
  return stream;
}

Finding Worst(const StreamFacts& stream, const std::string& topic) {
  Finding worst;
  for (const Finding& finding : JudgeStream(stream)) {
    if (finding.topic == topic && finding.verdict >= worst.verdict) worst = finding;
  }
  return worst;
}

bool Has(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

TEST(CheckFindings, GoodStreamIsReady) { EXPECT_TRUE(IsReady(JudgeStream(GoodStream()))); }

TEST(CheckFindings, NoPairIsNotGood) {
  StreamFacts stream = GoodStream();
  stream.pairs = 0;
  stream.unpaired = {100, 100};
  EXPECT_EQ(Worst(stream, "rate").verdict, Verdict::kMend);
  EXPECT_TRUE(Has(Worst(stream, "sync").advice, "--trigger"));
}

TEST(CheckFindings, LostImagesAreNoFaultOfTheTrigger) {
  StreamFacts stream = GoodStream();
  stream.frames[1] = stream.pairs = 85;
  stream.unpaired[0] = stream.lost[1] = 15;
  EXPECT_FALSE(Has(Worst(stream, "sync").advice, "trigger"));
  stream.jitter_ms = 3;
  EXPECT_TRUE(Has(Worst(stream, "sync").advice, "trigger"));
}

TEST(CheckFindings, CameraThatFellSilent) {
  StreamFacts stream = GoodStream();
  stream.frames[1] = stream.pairs = 50;
  const Finding silent = Worst(stream, "rate");
  EXPECT_EQ(silent.verdict, Verdict::kMend);
  EXPECT_EQ(silent.camera, "cam1");
  EXPECT_TRUE(Has(silent.text, "50 images in 2 s, expected 100")) << silent.text;
  stream = GoodStream();
  stream.down_s[0] = 0.3;
  EXPECT_TRUE(Has(Worst(stream, "rate").text, "0.3 s without connection"));
}

TEST(CheckFindings, LateStartIsNoSilence) {
  StreamFacts stream = GoodStream();
  stream.frames[1] = stream.pairs = 85;
  EXPECT_TRUE(IsReady(JudgeStream(stream)));
}

TEST(LeadCounter, CountsWhatCameBeforeTheFirstPair) {
  const auto frame = std::make_shared<const Frame>();
  LeadCounter lead;
  for (int i = 0; i < 3; ++i) lead.Take(frame, nullptr);
  lead.Take(nullptr, frame);
  EXPECT_EQ(lead.alone(0), 0) << "no pair came: then it is the take that is without";
  lead.Take(frame, frame);
  lead.Take(frame, nullptr);
  EXPECT_EQ(lead.alone(0), 3);
  EXPECT_EQ(lead.alone(1), 1);
}

}  // namespace
}  // namespace stereomotion::app
