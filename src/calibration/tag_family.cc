#include "tag_family.h"

#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h10.h>
#include <apriltag/tag36h11.h>

#include <stdexcept>

namespace stereomotion {

TagFamily MakeTagFamily(const std::string& name) {
  if (name == "tag36h11") return {tag36h11_create(), tag36h11_destroy};
  if (name == "tag36h10") return {tag36h10_create(), tag36h10_destroy};
  if (name == "tag25h9") return {tag25h9_create(), tag25h9_destroy};
  if (name == "tag16h5") return {tag16h5_create(), tag16h5_destroy};
  throw std::invalid_argument("tag family '" + name +
                              "': expected tag36h11, tag36h10, tag25h9 or tag16h5 (families "
                              "whose outer edge is black all around)");
}

}  // namespace stereomotion
