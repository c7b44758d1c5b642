#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

/// \file
/// Arrays that are constant after they are made.
namespace tuft {

/// Constant elements in memory, or in a mapped file, where only those that are touched take memory. Copies share them.
template <class T>
class SharedArray {
  public:
    SharedArray() = default;
    /// The owner keeps the elements alive.
    SharedArray(std::shared_ptr<const void> owner, std::span<const T> elements)
        : owner_(std::move(owner)), elements_(elements) {}

    const T& operator[](std::size_t i) const { return elements_[i]; }
    std::size_t size() const { return elements_.size(); }
    bool empty() const { return elements_.empty(); }
    const T* data() const { return elements_.data(); }
    auto begin() const { return elements_.begin(); }
    auto end() const { return elements_.end(); }

  private:
    std::shared_ptr<const void> owner_;
    std::span<const T> elements_;
};

}  // namespace tuft
