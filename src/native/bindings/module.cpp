// The Python module pinik._native; only pinik.solving.native uses it.
#include <coal/config.hh>         // only the version
#include <pinocchio/config.hpp>  // only the version

#include "../solving/pool.hpp"
#include "abi.hpp"
#include "interface.hpp"
#include "numbers.hpp"

NB_MODULE(_native, m) {
  pinik::nb::set_leak_warnings(false);  // what the thread of a live view holds lives until the process ends
  pinik::import_numpy();
  pinik::prepare_to_throw();
  m.doc() = "pinik's compiled engine; use it through pinik.solve, engine=\"native\".";
  m.attr("pinocchio_version") = PINOCCHIO_VERSION;
  m.attr("coal_version") = COAL_VERSION;
  m.attr("abi") = pinik::abi;
  pinik::register_descriptions(m);
  pinik::register_settings(m);
  pinik::register_answers(m);
  pinik::register_engine(m);
  pinik::register_calls(m);
  pinik::register_places(m);
  pinik::register_kinematics(m);
  pinik::register_track(m);
  pinik::register_pursuit(m);
  pinik::register_search(m);
  pinik::register_collisions(m);
}
