// Functions that recall the call that they answered last.
#pragma once

#include <nanobind/nanobind.h>

namespace pinik {

namespace nb = nanobind;

// A method or function like `function`. If all arguments except the place and the start are the very objects of the
// last call in this thread, and the Call that answered it still exists, that Call solves directly. Otherwise, and for
// arguments that the Call does not accept, `function` is called. `place` is the index of the place among the positional
// arguments, −1 if it has none. What a method's name means may not have changed since, as `methods` says.
nb::object recalling(nb::handle function, int place, nb::dict methods);

// Remember that this Call has answered; the function that is being called then recalls it.
void note(nb::handle call);

}  // namespace pinik
