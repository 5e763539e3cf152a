#pragma once

#include <sys/resource.h>

namespace mssim {

/// Lets this process have no more than so many bytes of address space, or says that it cannot: qemu-user
/// limits none. Undone at the end.
class AddressSpaceLimit {
 public:
  explicit AddressSpaceLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_AS, &before_);
    const rlimit tight{bytes, before_.rlim_max};
    rlimit set{};
    holds_ =
        ::setrlimit(RLIMIT_AS, &tight) == 0 && ::getrlimit(RLIMIT_AS, &set) == 0 && set.rlim_cur == bytes;
  }
  ~AddressSpaceLimit() { ::setrlimit(RLIMIT_AS, &before_); }
  AddressSpaceLimit(const AddressSpaceLimit&) = delete;
  AddressSpaceLimit& operator=(const AddressSpaceLimit&) = delete;

  bool holds() const { return holds_; }

 private:
  rlimit before_{};
  bool holds_ = false;
};

}  // namespace mssim
