#include "laparoscope_servo/tracking/view_store.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/error_text.h"
#include "support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {
namespace {

using test_support::errorText;
using Names = std::vector<std::string>;

const cv::Size kSize(320, 240);
const geometry::Rectangle kRoi = {110, 75, 100, 90};
constexpr int kStep = 100;  // px: the ROI of a view is in its neighbours' images, and hardly in those after them

class ViewStoreTest : public ::testing::Test {
 protected:
  const cv::Mat scene_ = test::tissue(cv::Size(900, 240), 51);
  ViewStore store_{TrackerConfig()};

  // A camera that has moved to the right by `x` px; each picture has light and noise of its own.
  cv::Mat at(int x) const {
    const double gain = 0.9 + 0.05 * (x / 10 % 3);
    return test::view(scene_(cv::Rect(cv::Point(x, 0), kSize)), Eigen::Matrix3d::Identity(), gain, 5.0, 2.0,
                      static_cast<unsigned>(x) + 1);
  }
  void storeRow(const Names& names) {
    for (std::size_t k = 0; k < names.size(); ++k) store_.store(names[k], at(kStep * static_cast<int>(k)), kRoi);
  }
};

TEST_F(ViewStoreTest, LinksNeighboursBothWaysAndNoOthers) {
  storeRow({"a", "b", "c", "d"});
  EXPECT_EQ(store_.names(), (Names{"a", "b", "c", "d"}));
  for (const int from : {0, 1, 2, 3}) {
    for (const int to : {0, 1, 2, 3}) {
      EXPECT_EQ(store_.leads(store_.names()[from], store_.names()[to]), std::abs(from - to) <= 1) << from << ' ' << to;
    }
  }
}

TEST_F(ViewStoreTest, GoesTheShortestWay) {
  storeRow({"a", "b", "c", "d"});
  EXPECT_EQ(store_.path("a", "d"), (Names{"a", "b", "c", "d"}));
  EXPECT_EQ(store_.path("d", "b"), (Names{"d", "c", "b"}));
  EXPECT_EQ(store_.path("c", "c"), Names{"c"});
  // From just before d the image shows c, too, and hardly anything of b's region.
  EXPECT_EQ(store_.route(at(290), "d").names, Names{"d"});
  EXPECT_EQ(store_.route(at(290), "a").names, (Names{"c", "b", "a"}));
  EXPECT_EQ(store_.route(at(290), "a").why, "");
}

TEST_F(ViewStoreTest, SaysWhyThereIsNoWay) {
  storeRow({"a", "b"});
  store_.store("far", at(500), kRoi);
  EXPECT_EQ(store_.path("a", "far"), Names());
  const ViewStore::Route apart = store_.route(at(20), "far");
  EXPECT_TRUE(apart.names.empty());
  EXPECT_NE(apart.why.find("overlaps with 'a', 'b'"), std::string::npos) << apart.why;
  const ViewStore::Route nowhere = store_.route(at(300), "a");
  EXPECT_TRUE(nowhere.names.empty());
  EXPECT_EQ(nowhere.why, "no stored view overlaps with the present image");
}

TEST_F(ViewStoreTest, FindsViewsTurnedAndZoomed) {
  store_.store("a", at(0), kRoi);
  const Eigen::Matrix3d g = test::zoomAndTurn(kRoi, 1.3, 0.6, Eigen::Matrix3d::Identity(), {150.0, 130.0});
  EXPECT_TRUE(store_.isSeen("a", test::view(scene_(cv::Rect(cv::Point(0, 0), kSize)), g)));
  EXPECT_FALSE(store_.isSeen("a", at(400)));
}

TEST_F(ViewStoreTest, AnImageOfAnotherSizeOrWithoutTextureShowsNoView) {
  store_.store("a", at(0), kRoi);
  EXPECT_FALSE(store_.isSeen("a", scene_));
  EXPECT_FALSE(store_.isSeen("a", cv::Mat(kSize, CV_8UC3, cv::Scalar(60, 70, 140))));
}

TEST_F(ViewStoreTest, ReplacesAViewOfTheSameName) {
  storeRow({"a", "b", "c"});
  store_.store("b", at(500), kRoi);
  EXPECT_EQ(store_.names().size(), 3u);
  EXPECT_FALSE(store_.leads("a", "b"));
  EXPECT_FALSE(store_.leads("b", "c"));
  EXPECT_EQ(store_.path("a", "c"), Names());
  store_.store("b", at(kStep), kRoi);
  EXPECT_EQ(store_.path("a", "c"), (Names{"a", "b", "c"}));
}

TEST_F(ViewStoreTest, KeepsACopyOfTheImage) {
  cv::Mat image = at(0);
  store_.store("a", image, {110.7, 75.2, 100.9, 90.0});
  image.setTo(0);
  EXPECT_TRUE(store_.isSeen("a", at(0)));
  EXPECT_EQ(store_.get("a").roi.x, 110.0);
  EXPECT_EQ(store_.get("a").roi.width, 100.0);
}

TEST_F(ViewStoreTest, RefusesWhatItCannotStoreAndStaysAsItWas) {
  store_ = ViewStore(TrackerConfig(), 2);
  storeRow({"a", "b"});
  EXPECT_NE(errorText<std::invalid_argument>([&] { store_.store("", at(0), kRoi); }).find("0 bytes"),
            std::string::npos);
  EXPECT_NE(errorText<std::invalid_argument>([&] { store_.store(std::string(65, 'x'), at(0), kRoi); }).find("65 bytes"),
            std::string::npos);
  const std::string full = errorText<std::invalid_argument>([&] { store_.store("c", at(0), kRoi); });
  EXPECT_NE(full.find("no place is left for view 'c'"), std::string::npos) << full;
  EXPECT_NE(full.find("'a', 'b'"), std::string::npos) << full;
  EXPECT_NE(errorText<std::invalid_argument>([&] { store_.store("a", at(0), {300, 75, 100, 90}); }), "");
  EXPECT_NE(
      errorText<std::invalid_argument>([&] { store_.store("a", cv::Mat(kSize, CV_8UC3, cv::Scalar(9, 9, 9)), kRoi); }),
      "");
  EXPECT_NE(errorText<std::invalid_argument>([&] { store_.store("a", cv::Mat(), kRoi); }), "");
  EXPECT_EQ(store_.names(), (Names{"a", "b"}));
  EXPECT_EQ(store_.path("a", "b"), (Names{"a", "b"}));
}

TEST_F(ViewStoreTest, NamesTheViewsThereAreWhenAnotherIsAskedFor) {
  EXPECT_NE(errorText<std::invalid_argument>([&] { store_.route(at(0), "x"); }).find("there is none"),
            std::string::npos);
  storeRow({"a"});
  for (const auto& call : std::vector<std::function<void()>>{
           [&] { store_.get("x"); }, [&] { store_.isSeen("x", at(0)); }, [&] { store_.leads("a", "x"); },
           [&] { store_.path("x", "a"); }, [&] { store_.path("a", "x"); }, [&] { store_.route(at(0), "x"); }}) {
    EXPECT_NE(errorText<std::invalid_argument>(call).find("no view 'x' is stored, expected one of 'a'"),
              std::string::npos)
        << errorText<std::invalid_argument>(call);
  }
}

TEST(UprightRoiTest, IsWhereTheRegionIs) {
  const cv::Rect image(cv::Point(0, 0), kSize);
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  const geometry::Rectangle same = uprightRoi(g, kRoi, image);
  EXPECT_EQ(same.x, kRoi.x);
  EXPECT_EQ(same.y, kRoi.y);
  EXPECT_EQ(same.width, kRoi.width);
  EXPECT_EQ(same.height, kRoi.height);
  const geometry::Rectangle wide = {100, 100, 81, 41};
  for (const double angle : {0.0, 0.3, 0.8, M_PI_2}) {
    const auto turned = test::zoomAndTurn(wide, 1.2, angle, Eigen::Matrix3d::Identity(), {150.0, 120.0});
    const geometry::Rectangle now = uprightRoi(turned, wide, image);
    EXPECT_LT((now.centre() - geometry::apply(turned, wide.centre())).norm(), 1.0) << angle;
    EXPECT_NEAR((now.width - 1) * (now.height - 1) / (96.0 * 48.0), 1.0, 0.03) << angle;
  }
  const auto upended = test::zoomAndTurn(wide, 1.0, M_PI_2, Eigen::Matrix3d::Identity(), {150.0, 120.0});
  EXPECT_EQ(uprightRoi(upended, wide, image).width, 41.0);
}

TEST(UprightRoiTest, StaysInTheImage) {
  const cv::Rect image(cv::Point(-5, 0), kSize);
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g.topRightCorner<2, 1>() << -150.0, 100.0;
  const geometry::Rectangle cut = uprightRoi(g, kRoi, image);
  EXPECT_EQ(cut.x, -5.0);
  EXPECT_EQ(cut.x + cut.width, kRoi.x - 150.0 + kRoi.width);
  EXPECT_EQ(cut.y + cut.height, 240.0);
  g(0, 2) = -400.0;
  EXPECT_THROW(uprightRoi(g, kRoi, image), std::invalid_argument);
  EXPECT_THROW(uprightRoi(-g, kRoi, cv::Rect()), std::invalid_argument);
  EXPECT_THROW(uprightRoi(Eigen::Matrix3d::Zero(), kRoi, image), std::invalid_argument);
}

TEST(ViewStoreConfigTest, IsChecked) {
  EXPECT_THROW(ViewStore(TrackerConfig(), 0), std::invalid_argument);
  TrackerConfig config;
  config.esm.levels = 0;
  EXPECT_THROW(ViewStore{config}, std::invalid_argument);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
