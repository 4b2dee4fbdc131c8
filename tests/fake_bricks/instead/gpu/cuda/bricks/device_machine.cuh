// In place of the device that a brick cache works on: its memory is the pretended one's, its steps run one after the
// other.
#pragma once

#include "gpu/cuda/runtime/device_array.h"
#include "tests/fake_cuda/fake_runtime.h"
#include "tests/gpu/bricks/host_machine.h"

namespace weir {

namespace test {

struct FakeMachine {
  template <class T>
  using Array = DeviceArray<T>;

  template <class Step>
  void each(std::uint32_t count, const Step& step) const {
    launch();
    HostMachine{}.each(count, step);
  }
  template <class Step>
  void groups(std::uint32_t count, const Step& step) const {
    launch();
    HostMachine{}.groups(count, step);
  }
  void wait() const {}
  template <class T>
  void clear(Array<T>& array) const {
    check_cuda(cudaMemsetAsync(array.data(), 0, array.bytes(), nullptr), "clearing device memory");
  }

 private:
  // A test can make it fail.
  static void launch() { check_cuda(FakeRuntime::instance().enter("launch"), "working on bricks"); }
};

}  // namespace test

using DeviceMachine = test::FakeMachine;

}  // namespace weir
