// SPDX-License-Identifier: BSD-3-Clause
// One pose gives the same bits, by whatever way it came.
#include <csom/maps/PoseRounding.h>
#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/math/CQuaternion.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/poses/CPose3DQuat.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

namespace {

using mrpt::poses::CPose3D;

bool sameBits(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return std::memcmp(a.data(), b.data(), 16 * sizeof(double)) == 0;
}

CPose3D serialisedCopy(const CPose3D& pose) {
  mrpt::poses::CPose3DPDFGaussian out(pose);
  mrpt::poses::CPose3DPDFGaussian in;
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << out;
  stream.Seek(0);
  archive >> in;
  return in.mean;
}

CPose3D byAngles(const CPose3D& pose) {
  return {pose.x(), pose.y(), pose.z(), pose.yaw(), pose.pitch(), pose.roll()};
}

CPose3D byQuaternion(const CPose3D& pose) {
  return CPose3D(mrpt::poses::CPose3DQuat(pose));
}

class RandomPoses {
 public:
  CPose3D next() {
    return {position_(random_), position_(random_), position_(random_),
            angle_(random_),    pitch_(random_),    angle_(random_)};
  }

 private:
  std::mt19937 random_{7};
  std::uniform_real_distribution<double> position_{-5e5, 5e5};
  std::uniform_real_distribution<double> angle_{-M_PI, M_PI};
  // At ±90° yaw and roll cannot be told apart, and angles are no representation any more.
  std::uniform_real_distribution<double> pitch_{-1.5, 1.5};
};

TEST(PoseRounding, CopiesOfAPoseHaveTheSameBits) {
  RandomPoses poses;
  for (int i = 0; i < 10000; ++i) {
    const CPose3D pose = poses.next();
    const Eigen::Isometry3d expected = csom::roundedPose(pose);
    ASSERT_TRUE(sameBits(csom::roundedPose(serialisedCopy(pose)), expected)) << i << pose;
    ASSERT_TRUE(sameBits(csom::roundedPose(byQuaternion(pose)), expected)) << i << pose;
    ASSERT_TRUE(sameBits(csom::roundedPose(byAngles(pose)), expected)) << i << pose;
  }
}

TEST(PoseRounding, HalfTurnsHaveTheSameBitsToo) {
  // w is 0 up to the last bits, and its sign is noise.
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 1000; ++i) {
    Eigen::Vector3d axis(normal(random), normal(random), normal(random));
    axis.normalize();
    const auto turned = [&](double w) {
      mrpt::math::CQuaternionDouble q(w, axis.x(), axis.y(), axis.z());
      mrpt::math::CMatrixDouble33 rotation;
      q.normalize();
      q.rotationMatrixNoResize(rotation);
      return CPose3D(rotation, mrpt::math::CVectorFixedDouble<3>());
    };
    const Eigen::Isometry3d expected = csom::roundedPose(turned(0));
    ASSERT_TRUE(sameBits(csom::roundedPose(turned(3e-16)), expected)) << axis.transpose();
    ASSERT_TRUE(sameBits(csom::roundedPose(turned(-3e-16)), expected)) << axis.transpose();
  }
}

TEST(PoseRounding, StaysCloseToThePose) {
  RandomPoses poses;
  for (int i = 0; i < 1000; ++i) {
    const CPose3D pose = poses.next();
    const Eigen::Isometry3d rounded = csom::roundedPose(pose);
    const Eigen::Matrix4d exact =
        pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen();
    const Eigen::Matrix4d difference = (rounded.matrix() - exact).cwiseAbs();
    ASSERT_LT(difference.topLeftCorner(3, 3).maxCoeff(), 5e-9);
    ASSERT_LT(difference.topRightCorner(3, 1).maxCoeff(), 5e-7);
    const Eigen::Matrix3d gram = rounded.linear() * rounded.linear().transpose();
    ASSERT_LT((gram - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(PoseRounding, IdentityStaysExact) {
  EXPECT_TRUE(sameBits(csom::roundedPose(CPose3D()), Eigen::Isometry3d::Identity()));
}

TEST(PoseRounding, RejectsWhatIsNotFinite) {
  CPose3D pose;
  pose.x(std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW(csom::roundedPose(pose), std::runtime_error);
  pose.x(1e15);
  EXPECT_THROW(csom::roundedPose(pose), std::runtime_error);
}

TEST(PoseRounding, ComposesRobotAndSensor) {
  const CPose3D robot(1, 2, 3, M_PI / 2, 0, 0);
  const CPose3D sensor(0.5, 0, 1, 0, 0.1, -0.2);
  const Eigen::Isometry3d pose = csom::sensorPoseInMap(csom::roundedPose(robot), sensor);
  const CPose3D expected = robot + sensor;
  const Eigen::Matrix4d matrix =
      expected.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen();
  EXPECT_LT((pose.matrix() - matrix).cwiseAbs().maxCoeff(), 1e-6);
}

}  // namespace
