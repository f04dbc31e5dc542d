// What follows from a model's points and polygons: normals, edges with their faces, size.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "laparoscope_servo/model/cad_model.h"

namespace laparoscope_servo::model {

// The polygon of points 0 to n - 1 in order: why it is no face, or empty. Fills normal and centre.
std::string completeFace(const std::vector<Eigen::Vector3d>& points, Face& face);

// The polygon that lines, pairs of points, make when they follow one another; empty when they make none.
std::vector<int> chain(const std::vector<std::pair<int, int>>& lines);

// Adds the edges of the faces and the wires to the model, and fills centre, radius and convex. `wires`: lines that
// belong to no face.
void completeModel(const std::vector<std::pair<int, int>>& wires, CadModel& model);

}  // namespace laparoscope_servo::model
