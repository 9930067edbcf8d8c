#pragma once
/// Addresses that are kept back for libraries which do not survive a refused allocation.
#include <cstddef>

namespace muldi::base {

/// Holds nothing, at no cost, unless the process may have so many addresses only (`ulimit -v`).
class AddressReserve {
 public:
  explicit AddressReserve(std::size_t bytes);
  ~AddressReserve() { release(); }
  AddressReserve(const AddressReserve&) = delete;
  AddressReserve& operator=(const AddressReserve&) = delete;

  bool is_limited() const { return limited_; }
  /// Throws std::bad_alloc if so much is not left.
  void take();
  /// The same, without it where it is not left.
  void try_take() noexcept;
  void release() noexcept;

  /// Leaves the addresses to others as long as it lives.
  class Use {
   public:
    explicit Use(AddressReserve& reserve) : reserve_(reserve) { reserve.release(); }
    ~Use() { reserve_.try_take(); }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    AddressReserve& reserve_;
  };

 private:
  std::size_t bytes_;
  bool limited_;
  void* held_ = nullptr;
};

}  // namespace muldi::base
