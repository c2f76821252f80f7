// The last word on an answer: forward kinematics by plain Pinocchio, which the solvers do not use.
#pragma once

#include <memory>

#include "problem.hpp"

namespace pinik {

// A robot as a model of Pinocchio's own.
class Certifier {
 public:
  // One thread's working memory.
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

  // Each target's error at q.
  std::vector<TargetError> errors(const Problem& problem, const Vector& q, Memory& memory) const;

 private:
  struct Model;
  std::unique_ptr<Model> model_;
};

}  // namespace pinik
