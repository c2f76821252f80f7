// A robot as the engine keeps it.
#pragma once

#include <memory>

#include "../model/mechanism.hpp"
#include "certifier.hpp"

namespace pinik {

struct Robot {
  Mechanism mechanism;
  std::unique_ptr<Certifier> certifier;

  // Call this when all joints have been added.
  void finish() { certifier = std::make_unique<Certifier>(mechanism); }
};

}  // namespace pinik
