// SPDX-License-Identifier: BSD-3-Clause
// CameraProjection against OpenCV's own projections, and where lens models end.
#include <csom/core/Error.h>
#include <csom/vision/CameraProjection.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <random>
#include <string>
#include <vector>

namespace csom {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::HasSubstr;

constexpr double kPi = 3.14159265358979323846;

class RandomLens {
 public:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }

  CameraCalibration calibration(LensDistortion distortion) {
    CameraCalibration c{640, 480, 0, 0, 0, 0, distortion, {}};
    c.fx = uniform(150, 1200);
    c.fy = uniform(150, 1200);
    c.cx = uniform(250, 400);
    c.cy = uniform(180, 300);
    if (distortion == LensDistortion::PlumbBob) {
      for (std::size_t i = 0; i < 8; ++i) {
        const double size = i == 2 || i == 3 ? 0.01 : 0.4;
        c.coefficients[i] = uniform(-size, size);
      }
    } else if (distortion == LensDistortion::KannalaBrandt) {
      for (std::size_t i = 0; i < 4; ++i) c.coefficients[i] = uniform(-0.05, 0.05);
    }
    return c;
  }

  /// Up to `angle` off the optical axis.
  Vector3d point(double angle) {
    const double off_axis = uniform(0, angle);
    const double around = uniform(-kPi, kPi);
    return uniform(0.3, 80) * Vector3d(std::sin(off_axis) * std::cos(around),
                                       std::sin(off_axis) * std::sin(around), std::cos(off_axis));
  }

 private:
  std::mt19937 engine_{5};
};

Vector2d projectedByOpenCv(const CameraCalibration& c, const Vector3d& point) {
  const std::vector<cv::Point3d> points{{point.x(), point.y(), point.z()}};
  const cv::Matx33d camera(c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1);
  const cv::Vec3d zero(0, 0, 0);
  std::vector<cv::Point2d> pixels;
  if (c.distortion == LensDistortion::KannalaBrandt) {
    const std::vector<double> k(c.coefficients.begin(), c.coefficients.begin() + 4);
    cv::fisheye::projectPoints(points, pixels, zero, zero, camera, k);
  } else {
    const std::vector<double> k(c.coefficients.begin(), c.coefficients.end());
    cv::projectPoints(points, zero, zero, camera, k, pixels);
  }
  return {pixels.at(0).x, pixels.at(0).y};
}

class AgainstOpenCv : public testing::TestWithParam<LensDistortion> {};

TEST_P(AgainstOpenCv, RandomLensesAndPoints) {
  RandomLens random;
  int projected = 0;
  for (int lens = 0; lens < 200; ++lens) {
    const CameraCalibration calibration = random.calibration(GetParam());
    const CameraProjection projection(calibration);
    for (int i = 0; i < 100; ++i) {
      const Vector3d point = random.point(1.2);
      const auto pixel = projection.project(point);
      if (!pixel) continue;
      ++projected;
      ASSERT_LT((*pixel - projectedByOpenCv(calibration, point)).norm(), 1e-3)
          << "lens " << lens << ", point " << point.transpose();
    }
  }
  EXPECT_GT(projected, 8000);
}

INSTANTIATE_TEST_SUITE_P(EveryModel, AgainstOpenCv,
                         testing::Values(LensDistortion::None, LensDistortion::PlumbBob,
                                         LensDistortion::KannalaBrandt));

/// Where OpenCV's projection, followed outwards along the x axis, turns back: the lens model ends.
double angleAtWhichOpenCvTurnsBack(const CameraCalibration& c, double end) {
  double last = projectedByOpenCv(c, {0, 0, 1}).x();
  for (double angle = 0.001; angle < end; angle += 0.001) {
    const double u = projectedByOpenCv(c, {std::sin(angle), 0, std::cos(angle)}).x();
    if (u <= last) return angle;
    last = u;
  }
  return end;
}

TEST(CameraProjection, EndsWhereTheLensTurnsBack) {
  RandomLens random;
  int turning = 0;
  for (int lens = 0; lens < 200; ++lens) {
    CameraCalibration calibration = random.calibration(
        lens % 2 == 0 ? LensDistortion::PlumbBob : LensDistortion::KannalaBrandt);
    if (calibration.distortion == LensDistortion::PlumbBob)
      calibration.coefficients[2] = calibration.coefficients[3] = 0;
    const double turn = angleAtWhichOpenCvTurnsBack(calibration, 1.5);
    if (turn == 1.5) continue;
    ++turning;
    const CameraProjection projection(calibration);
    const auto at = [&](double angle) {
      return projection.project({0, std::sin(angle), std::cos(angle)});
    };
    EXPECT_TRUE(at(turn - 0.003)) << "lens " << lens << " turns at " << turn;
    EXPECT_FALSE(at(turn + 0.003)) << "lens " << lens << " turns at " << turn;
    EXPECT_FALSE(at(1.55)) << "lens " << lens;
  }
  EXPECT_GT(turning, 50);
}

TEST(CameraProjection, NothingFoldsBackIntoTheImage) {
  const CameraCalibration calibration{640,   480, 300, 300, 319.5, 239.5, LensDistortion::PlumbBob,
                                      {-0.3}};
  const Vector3d far_off_axis(1.75, 0, 1);
  const CameraProjection projection(calibration);
  ASSERT_TRUE(projection.contains(projectedByOpenCv(calibration, far_off_axis)))
      << "a naive projection sees it";
  EXPECT_FALSE(projection.project(far_off_axis));
  // d/dr (r − 0.3 r³) = 0 at r = 1.0541.
  EXPECT_TRUE(projection.project({1.053, 0, 1}));
  EXPECT_FALSE(projection.project({0, -1.055, 1}));
}

TEST(CameraProjection, TangentialDistortionNeverBringsTwoPointsToOnePixel) {
  RandomLens random;
  for (int lens = 0; lens < 100; ++lens) {
    CameraCalibration calibration = random.calibration(LensDistortion::PlumbBob);
    calibration.coefficients[2] *= 10;
    calibration.coefficients[3] *= 10;
    const CameraProjection projection(calibration);
    for (int i = 0; i < 200; ++i) {
      const Vector3d p = random.point(1.4);
      const Vector3d a = p / p.z();
      const double around = random.uniform(-kPi, kPi);
      const Vector3d b = a + 1e-4 * Vector3d(std::cos(around), std::sin(around), 0);
      const auto pixel_a = projection.project(a);
      const auto pixel_b = projection.project(b);
      if (!pixel_a || !pixel_b) continue;
      // One-to-one and not mirrored: a step in the scene is a step in that direction.
      const Vector2d step =
          (*pixel_b - *pixel_a).cwiseQuotient(Vector2d(calibration.fx, calibration.fy));
      ASSERT_GT(step.dot((b - a).head<2>()), 0) << "lens " << lens << " at " << a.transpose();
    }
  }
}

TEST(CameraProjection, NothingBehindAPlaneImage) {
  for (const LensDistortion distortion : {LensDistortion::None, LensDistortion::PlumbBob}) {
    const CameraProjection projection({640, 480, 300, 300, 319.5, 239.5, distortion, {0.01}});
    EXPECT_TRUE(projection.project({0, 0, 1}));
    EXPECT_FALSE(projection.project({0, 0, -1}));
    EXPECT_FALSE(projection.project({0.1, 0.2, 0}));
    EXPECT_FALSE(projection.project({0, 0, 0}));
    EXPECT_FALSE(projection.project({1, 0, 1e-320})) << "1 / z is not finite";
  }
}

TEST(CameraProjection, AFisheyeSeesBesideAndBehindItself) {
  const CameraProjection projection(
      {1000, 1000, 250, 250, 499.5, 499.5, LensDistortion::KannalaBrandt, {}});
  const auto pixel_at = [&](double angle) {
    return projection.project({2 * std::sin(angle), 0, 2 * std::cos(angle)});
  };
  for (const double angle : {0.1, kPi / 2, 1.9, 3.1}) {
    ASSERT_TRUE(pixel_at(angle)) << angle;
    EXPECT_NEAR(pixel_at(angle)->x(), 499.5 + 250 * angle, 1e-9);
    EXPECT_NEAR(pixel_at(angle)->y(), 499.5, 1e-9);
  }
  EXPECT_FALSE(projection.project({0, 0, -1})) << "straight behind, in no direction";
  EXPECT_EQ(*projection.project({0, 0, 1}), Vector2d(499.5, 499.5));

  // 1 − 3·0.1·θ² = 0 at 1.826 rad, behind the camera.
  const CameraProjection narrow(
      {1000, 1000, 250, 250, 499.5, 499.5, LensDistortion::KannalaBrandt, {-0.1}});
  EXPECT_TRUE(narrow.project({0, std::sin(1.82), std::cos(1.82)}));
  EXPECT_FALSE(narrow.project({0, std::sin(1.83), std::cos(1.83)}));
}

TEST(CameraProjection, PointsThatAreNotFiniteHaveNoPixel) {
  for (const LensDistortion distortion :
       {LensDistortion::None, LensDistortion::PlumbBob, LensDistortion::KannalaBrandt}) {
    const CameraProjection projection({640, 480, 300, 300, 319.5, 239.5, distortion, {}});
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
      EXPECT_FALSE(projection.project({bad, 0, 1}));
      EXPECT_FALSE(projection.project({0, bad, 1}));
      EXPECT_FALSE(projection.project({0, 0, -bad}));
    }
    EXPECT_FALSE(projection.project(Vector3d::Constant(std::nan(""))));
  }
}

TEST(CameraProjection, ContainsWhatRoundsToAPixel) {
  const CameraProjection projection({640, 480, 300, 300, 319.5, 239.5, LensDistortion::None, {}});
  EXPECT_TRUE(projection.contains({-0.5, -0.5}));
  EXPECT_TRUE(projection.contains({639.499, 479.499}));
  EXPECT_FALSE(projection.contains({-0.501, 0}));
  EXPECT_FALSE(projection.contains({0, -0.501}));
  EXPECT_FALSE(projection.contains({639.5, 0}));
  EXPECT_FALSE(projection.contains({0, 479.5}));
  EXPECT_FALSE(projection.contains({std::nan(""), 0}));
}

std::string errorOf(const CameraCalibration& calibration) {
  try {
    CameraProjection projection(calibration);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(CameraProjection, BadCalibrationsNameTheValue) {
  const CameraCalibration good{640, 480, 300, 310, 319.5, 239.5, LensDistortion::PlumbBob, {}};
  EXPECT_EQ(errorOf(good), "no error");
  CameraCalibration bad = good;
  bad.width = 0;
  EXPECT_THAT(errorOf(bad), HasSubstr("width = 0"));
  bad = good;
  bad.height = -480;
  EXPECT_THAT(errorOf(bad), HasSubstr("height = -480"));
  bad = good;
  bad.fx = 0;
  EXPECT_THAT(errorOf(bad), HasSubstr("fx = 0"));
  bad = good;
  bad.fy = -310.5;
  EXPECT_THAT(errorOf(bad), HasSubstr("fy = -310.5"));
  bad.fy = std::numeric_limits<double>::infinity();
  EXPECT_THAT(errorOf(bad), HasSubstr("fy = inf"));
  bad = good;
  bad.cx = std::nan("");
  EXPECT_THAT(errorOf(bad), HasSubstr("cx = nan"));
  bad = good;
  bad.cy = std::numeric_limits<double>::infinity();
  EXPECT_THAT(errorOf(bad), HasSubstr("cy = inf"));
  bad = good;
  bad.coefficients[4] = std::nan("");
  EXPECT_THAT(errorOf(bad), HasSubstr("coefficient 5 = nan"));
}

TEST(CameraProjection, CalibrationsAreEqualIfAllValuesAre) {
  const CameraCalibration a{640, 480, 300, 310, 319.5, 239.5, LensDistortion::PlumbBob, {0.1}};
  CameraCalibration b = a;
  EXPECT_TRUE(a == b);
  b.coefficients[7] = 1e-9;
  EXPECT_FALSE(a == b);
  b = a;
  b.distortion = LensDistortion::None;
  EXPECT_FALSE(a == b);
}

}  // namespace
}  // namespace csom
