// What counts as grey in a picture: lamp, white balance and tissue differ, so each picture tells.
#pragma once

#include "features/shafts/grey_map.h"
#include "laparoscope_servo/image/field_of_view.h"

namespace laparoscope_servo::features {

struct GreyLevels {
  double threshold = 0.0;  // as GreyMap::colour: below it is grey
  double usual = 0.0;      // units of S0 cos H / mean: the colour of most of the picture, the tissue's
};

GreyLevels greyLevels(const GreyMap& map, const image::FieldOfView& view);

}  // namespace laparoscope_servo::features
