#include "app/case/plan_steps.h"

#include <utility>

namespace arthronaut::open_case {

namespace {

class SetTunnel : public Step {
 public:
  SetTunnel(TunnelSetter set, bones::BoneKind bone, std::optional<tunnels::Tunnel> before,
            std::optional<tunnels::Tunnel> after, std::string description)
      : set_(std::move(set)),
        bone_(bone),
        before_(std::move(before)),
        after_(std::move(after)),
        description_(std::move(description)) {}

  void redo() override { set_(bone_, after_); }
  void undo() override { set_(bone_, before_); }
  [[nodiscard]] std::string describe() const override { return description_; }
  bool absorb(const Step& later) override {
    const auto* same = dynamic_cast<const SetTunnel*>(&later);
    if (same == nullptr || same->bone_ != bone_) return false;
    after_ = same->after_;
    return true;
  }

 private:
  TunnelSetter set_;
  bones::BoneKind bone_;
  std::optional<tunnels::Tunnel> before_, after_;
  std::string description_;
};

}  // namespace

std::unique_ptr<Step> set_tunnel(TunnelSetter set, bones::BoneKind bone,
                                 std::optional<tunnels::Tunnel> before, std::optional<tunnels::Tunnel> after,
                                 std::string description) {
  return std::make_unique<SetTunnel>(std::move(set), bone, std::move(before), std::move(after),
                                     std::move(description));
}

}  // namespace arthronaut::open_case
