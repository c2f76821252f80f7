// The parts of the module pinik._native, each registered by a file of its own.
#pragma once

#include <nanobind/nanobind.h>

namespace pinik {

namespace nb = nanobind;

void register_descriptions(nb::module_& m);  // Constants, Robot and Problem
void register_settings(nb::module_& m);      // Solver and Settings
void register_answers(nb::module_& m);       // Status and Answer
void register_engine(nb::module_& m);        // Engine
void register_track(nb::module_& m);         // OnMiss and Track
void register_pursuit(nb::module_& m);      // Pursuit
void register_search(nb::module_& m);        // Searcher
void register_calls(nb::module_& m);         // Call, recalling
void register_places(nb::module_& m);        // read_places
void register_kinematics(nb::module_& m);    // ReferenceFrame and FrameWalk
void register_collisions(nb::module_& m);    // SolidKind, Geometry and Shapes

}  // namespace pinik
