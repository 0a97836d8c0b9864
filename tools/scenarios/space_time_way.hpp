// Whether a vehicle can pass a scenario's objects or stop at all, judged in space and time without a controller. Like
// possible_way.hpp, for any traffic and target speeds that change.
//
// A point mass moves along the road by a dynamic program over its place and speed, its lateral place and time; the objects
// move as they truly will (road_occupancy.hpp). Its acceleration is within 0.7 μ g together with υ² |κ|, its speed at most
// the target's and 2 %. Speeds are changed at steps of at least 0.8 s. Sideways it moves by at most 1.5 m/s and 0.3 υ; and,
// since it first has to accelerate, by at most 0.7 μ g t²/4 from where it intended to be t after perceiving something new.
//
// It knows an object only from its perception on. Until the next one is perceived, it drives as fast as the target and as
// near to the path as a way among those that it knows allows, with 0.55 μ g if there is such a way.
//
// This is an upper bound of what a controller can do, which is told the state with noise, the friction wrongly and the
// objects' future not at all. It neglects the vehicle's dynamics, its heading, and the lateral acceleration of the second
// and later shifts; that a way which is good for what is known may be bad for what comes; and those who follow. It is
// too strict by the grid's width and by enclosing each object in a rectangle along the road.
#pragma once

#include "sim/scenario.hpp"
#include "tools/scenarios/possible_way.hpp"

namespace tools {

// kPass: to the end of the route within twice its time plus 10 s. kStop: to a standstill without a contact before it.
[[nodiscard]] PossibleWay FindSpaceTimeWay(const sim::Scenario& scenario);

}  // namespace tools
