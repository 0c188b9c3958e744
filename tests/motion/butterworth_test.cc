#include "motion/butterworth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

namespace stereomotion::testing {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct ScipyCase {
  int order;
  double values[6];  // at samples 0, 1, 7, 20, 38, 39
};

// python3 (scipy 1.17.1): n=40; fs=30; fc=6; t=np.arange(n)/fs; m=order//2
//   x=np.sin(2*np.pi*1.3*t)+0.3*np.cos(2*np.pi*7*t+0.4)+0.1*t**2+0.5
//   wn=np.arctan(np.tan(np.pi*fc/fs)/(2**.5-1)**(1/(2*m)))/np.pi*2
//   y=scipy.signal.sosfiltfilt(scipy.signal.butter(m,wn,output='sos'),x,padlen=25)
constexpr ScipyCase kScipy[] = {
    {2,
     {0.776318298200865, 0.705313076012075, 1.37621942152694, -0.210477983351399,
      0.0387548939990734, -0.105898594361349}},
    {4,
     {0.776318298189434, 0.675620469089288, 1.39964227790068, -0.217018653759329,
      -0.0170007630696778, -0.10589859436395}},
    {6,
     {0.776318260823482, 0.662169772230958, 1.40862691168633, -0.213481371856201,
      -0.0591561142254165, -0.105898853746456}},
    {8,
     {0.776319531859039, 0.660701409298262, 1.41281757793524, -0.209940050946458,
      -0.0911884759909739, -0.105910577111116}},
};

TEST(Butterworth, AgreesWithScipyToItsDigits) {
  constexpr int kPadding = 25, kAt[6] = {0, 1, 7, 20, 38, 39};
  Eigen::VectorXd x(40);
  for (int i = 0; i < 40; ++i) {
    const double t = i / 30.0;
    x[i] = std::sin(2 * kPi * 1.3 * t) + 0.3 * std::cos(2 * kPi * 7 * t + 0.4) + 0.1 * t * t + 0.5;
  }
  for (const ScipyCase& expected : kScipy) {
    const auto sections = DesignZeroPhaseButterworth(expected.order, 6, 30);
    const Eigen::VectorXd y = FilterForwardBackward(sections, x, kPadding);
    for (int k = 0; k < 6; ++k) {
      EXPECT_NEAR(y[kPadding + kAt[k]], expected.values[k], 1e-13) << expected.order;
    }
  }
}

/// Amplitude of one pass at a frequency.
double Gain(const std::vector<FilterSection>& sections, double hz, double rate_hz) {
  const std::complex<double> z = std::polar(1.0, -2 * kPi * hz / rate_hz);
  std::complex<double> gain = 1;
  for (const FilterSection& f : sections) {
    gain *= (f.b0 + f.b1 * z + f.b2 * z * z) / (1.0 + f.a1 * z + f.a2 * z * z);
  }
  return std::abs(gain);
}

TEST(Butterworth, BothPassesTogetherHaveThreeDecibelsAtTheCutoff) {
  for (const int order : {2, 4, 6, 10}) {
    for (const double cutoff_hz : {0.5, 6.0, 14.9}) {
      const auto sections = DesignZeroPhaseButterworth(order, cutoff_hz, 30);
      const double pass = Gain(sections, cutoff_hz, 30);
      EXPECT_NEAR(pass * pass, std::sqrt(0.5), 1e-10) << order << " " << cutoff_hz;
      EXPECT_NEAR(Gain(sections, 0, 30), 1, 1e-10);
    }
  }
}

TEST(Butterworth, RefusesWhatCannotBe) {
  EXPECT_THROW(DesignZeroPhaseButterworth(3, 6, 30), std::invalid_argument);
  EXPECT_THROW(DesignZeroPhaseButterworth(0, 6, 30), std::invalid_argument);
  EXPECT_THROW(DesignZeroPhaseButterworth(4, 15, 30), std::invalid_argument);
  // 30 frames/s by times in whole ns: a hair more than 30.
  EXPECT_THROW(DesignZeroPhaseButterworth(4, 15, 1 / 0.033333333), std::invalid_argument);
  EXPECT_THROW(DesignZeroPhaseButterworth(4, 0, 30), std::invalid_argument);
  EXPECT_THROW(DesignZeroPhaseButterworth(4, std::nan(""), 30), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion::testing
