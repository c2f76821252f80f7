// Measures an answer's errors by Pinocchio's own forward kinematics, which the solvers do not use, on the same model as in
// Python; follows pinik.solving.verdict.measure_errors, and rounds as it does.
#pragma once

#include <memory>

#include "../problem/problem.hpp"

namespace pinik {

// A robot as a Pinocchio model.
class Certifier {
 public:
  // The working memory of one thread.
  class Memory {
   public:
    explicit Memory(const Certifier& certifier);
    ~Memory();

   private:
    friend class Certifier;
    struct Data;
    std::unique_ptr<Data> data_;
  };

  explicit Certifier(const Mechanism& mechanism);
  ~Certifier();

  // The error of each target at q.
  std::vector<TargetError> errors(const Problem& problem, const Vector& q, Memory& memory) const;

 private:
  struct Model;
  std::unique_ptr<Model> model_;
};

}  // namespace pinik
