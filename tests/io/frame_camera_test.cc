#include <gtest/gtest.h>

#include "frame_test_support.h"

namespace stereomotion {
namespace {

using testing::FrameFolder;
using testing::Has;

TEST(FrameCamera, ImagesInNaturalOrder) {
  FrameFolder folder;
  for (const char* name : {"a/img10.png", "a/img9.png", "a/img2.PNG", "a/notes.txt", "a/.x.png"}) {
    folder.Write(name);
  }
  for (const char* name : {"b/img1.png", "b/img2.png", "b/img3.png", "b/imgs10.png"}) {
    folder.Write(name);
  }
  folder.cam0 = "images: a", folder.cam1 = "images: 'b/img?.png'";
  const auto images = folder.Read().cameras[0].images;
  ASSERT_EQ(images.size(), 3U);
  EXPECT_EQ(images[0].filename(), "img2.PNG");
  EXPECT_EQ(images[1].filename(), "img9.png");
  EXPECT_EQ(images[2].filename(), "img10.png");
}

TEST(FrameCamera, ImageErrors) {
  FrameFolder folder;
  const auto error = [&](const std::string& images) {
    folder.cam0 = "images: " + images;
    return folder.ErrorText();
  };
  EXPECT_TRUE(Has(error("cam0/*.tif"), "fits none of the 2 files in"));
  EXPECT_TRUE(Has(error("cam0/*.tif"), "the first 1.png"));
  EXPECT_TRUE(Has(error("cam9/*.png"), "there is no folder"));
  EXPECT_TRUE(Has(error("cam0/9.png"), "there is no "));
  EXPECT_TRUE(Has(error("cam*/1.png"), "* and ? behind the last / only"));
  EXPECT_TRUE(Has(error("'*.csv'"), "expected images: PNG"));
  EXPECT_TRUE(Has(error("cam0/1.png"), "found 1 images of cam0 and 2 of cam1"));
  EXPECT_TRUE(Has(error("cam1/*.png"), "the same images for cam0 and cam1"));
  EXPECT_TRUE(Has(error("cam0/*.png, observations: seeds.csv"), "both images and observations"));
}

TEST(FrameCamera, Observations) {
  FrameFolder folder;
  folder.Write("o.csv", "id,u_px,v_px,sigma_px,view\nx1,10,20,0.1,0\nx1,11,21,0.2,3\n");
  folder.cam0 = "observations: o.csv, image_size_px: [640, 480]";
  folder.cam1 = folder.cam0;
  const FrameFile frame = folder.Read();
  const MeasuredPoint& measured = frame.cameras[1].observations[1];
  EXPECT_EQ(measured.point, 1);
  EXPECT_EQ(measured.view, 3);
  EXPECT_EQ(measured.pixel_px, Eigen::Vector2d(11, 21));
  EXPECT_EQ(measured.sigma_px, 0.2);
  EXPECT_EQ(frame.num_views, 4);
  folder.cam1 = "images: cam1";
  EXPECT_TRUE(Has(folder.ErrorText(), "found view 3 in the observations of cam0"));
  folder.cam0 = "observations: o.csv";
  EXPECT_TRUE(Has(folder.ErrorText(), "image_size_px"));
}

TEST(FrameCamera, ObservationErrors) {
  FrameFolder folder;
  folder.cam0 = "observations: o.csv, image_size_px: [640, 480]";
  const auto error = [&](const std::string& text) {
    folder.Write("o.csv", text);
    return folder.ErrorText();
  };
  EXPECT_TRUE(Has(error("id,u_px,v_px\nx1,1,1\n\nx1,2,2\n"), "point 'x1' twice in view 0"));
  EXPECT_TRUE(Has(error("id,u_px,v_px\nx1,1,900\n"), "o.csv:2: u_px: found (1, 900)"));
  EXPECT_TRUE(Has(error("id,u_px,v_px,sigma_px\nx1,1,1,0\n"), "o.csv:2: sigma_px: found 0"));
  EXPECT_TRUE(Has(error("id,u_px,v_px,view\nx1,1,1,-1\n"), "a whole number from 0"));
  EXPECT_TRUE(Has(error("id,u_px,v_px\nx1,1,1e\n"), "o.csv:2: v_px: found '1e'"));
  EXPECT_TRUE(Has(error("id,u_px,v_px\nx1,1\n"), "o.csv:2: found 2 cells, expected 3"));
  EXPECT_TRUE(Has(error("id,u_pix,v_px\nx1,1,1\n"), "o.csv:1: found the column 'u_pix'"));
  EXPECT_TRUE(Has(error("id,u_pix,v_px\nx1,1,1\n"), "did you mean 'u_px'?"));
  EXPECT_TRUE(Has(error("id;u_px;v_px\nx1;1;1\n"), "separated by commas"));
  EXPECT_TRUE(Has(error("id,u_px\nx1,1\n"), "the column 'v_px' is missing"));
  EXPECT_TRUE(Has(error(""), "o.csv: holds no rows"));
}

TEST(FrameCamera, SeedErrors) {
  FrameFolder folder;
  const auto error = [&](const std::string& rows) {
    folder.Write("seeds.csv", "# rough\nid,u_px,v_px\n" + rows);
    return folder.ErrorText();
  };
  const std::string unknown = error("x1,1,1\nx9,1,1\n");
  EXPECT_TRUE(Has(unknown, "seeds.csv:4: id: found 'x9', expected an id of the target")) << unknown;
  EXPECT_TRUE(Has(unknown, "did you mean 'x0'?")) << unknown;
  EXPECT_TRUE(Has(error("x1,1,1\nx1,1,1\n"), "seeds.csv:4: id: found 'x1' twice"));
  EXPECT_TRUE(Has(error("x1,1,1\nx2,1,1\n"), "found 2 seeds"));
  folder.cam0 = "images: cam0, seeds: none.csv";
  EXPECT_TRUE(Has(folder.ErrorText(), "none.csv: cannot be read"));
}

TEST(FrameCamera, CameraErrors) {
  FrameFolder folder;
  const auto error = [&](const std::string& more) {
    folder.cam0 = "images: cam0, " + more;
    return folder.ErrorText();
  };
  EXPECT_TRUE(Has(error("seed: x"), "did you mean 'seeds'?"));
  EXPECT_TRUE(Has(error("free: [fx, fy, k9]"), "found 'k9'"));
  EXPECT_TRUE(Has(error("free: [fx_px]"), "did you mean 'fx'?"));
  EXPECT_TRUE(Has(error("free: [fx, fx]"), "'fx' twice"));
  EXPECT_TRUE(Has(error("free: [fx]"), "found no fy in free"));
  EXPECT_EQ(error("free: [], initial: {fx_px: 900, fy_px: 900}"), "no error");
  EXPECT_TRUE(Has(error("initial: {fx: 900}"), "did you mean 'fx_px'?"));
  EXPECT_TRUE(Has(error("initial: {fx_px: 8}"), "the focal length in pixels (not in mm)"));
  EXPECT_TRUE(Has(error("image_size_px: [1, 2, 3]"), "expected a list of 2 numbers"));
  EXPECT_TRUE(Has(error("world_images: cam0"), "the file has no world_points"));
  folder.cam0 = "images: cam0}\n  - {name: cam1, images: cam0";
  EXPECT_TRUE(Has(folder.ErrorText(), "'cam1' twice"));
}

}  // namespace
}  // namespace stereomotion
