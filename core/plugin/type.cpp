#include "plugin/type.hpp"

#include <utility>

#include "plugin/host.hpp"

namespace koppel {

std::string_view plugin_kind_name(PluginKind kind) {
  switch (kind) {
    case PluginKind::joint: return "joint";
    case PluginKind::body: return "body";
    case PluginKind::constraint: return "constraint";
    case PluginKind::function: return "function";
    case PluginKind::force: return "force";
  }
  return "type";
}

Instance::Instance(void* pointer, void (*destroy)(void*), std::shared_ptr<const void> library)
    : pointer_(pointer), destroy_(destroy), library_(std::move(library)) {}

Instance::Instance(Instance&& other) noexcept
    : pointer_(std::exchange(other.pointer_, nullptr)),
      destroy_(std::exchange(other.destroy_, nullptr)),
      library_(std::move(other.library_)) {}

Instance& Instance::operator=(Instance&& other) noexcept {
  std::swap(pointer_, other.pointer_);
  std::swap(destroy_, other.destroy_);
  std::swap(library_, other.library_);
  return *this;
}

Instance::~Instance() {
  // library_ is released after this body: the code of destroy_ is still there.
  if (pointer_ != nullptr && destroy_ != nullptr) {
    guarded([this]() -> koppel_status {
      destroy_(pointer_);
      return KOPPEL_OK;
    });
  }
}

namespace {

koppel_value lower(const Parameter& parameter, const Value& value) {
  koppel_value out{};
  out.struct_size = sizeof(koppel_value);
  out.given = value.given ? 1 : 0;
  out.reals = value.numbers.empty() ? nullptr : value.numbers.data();
  out.count = value.count;
  out.text = parameter.kind == ParameterKind::string && value.count > 0 ? value.text.c_str() : nullptr;
  return out;
}

Error refusal(const Type& type, std::optional<koppel_status> status, const std::optional<Host::Rejection>& reason) {
  Error error;
  error.code = Code::instance_refused;
  error.message = "type `" + type.name + "` refuses ";
  if (!reason) {
    error.message += "its parameters and says no more: create() " + describe_failure(status);
    return error;
  }
  error.message += reason->parameter.empty() ? "its parameters" : '`' + reason->parameter + '`';
  if (!reason->message.empty()) error.message += ": " + reason->message;
  error.advice = reason->advice;
  return error;
}

}  // namespace

Result<Instance> Type::create(std::span<const Value> values) const {
  if (values.size() != parameters.size()) {
    Error error;
    error.message = "type `" + name + "` has " + std::to_string(parameters.size()) + " parameters, but got " +
                    std::to_string(values.size()) + " values";
    return tl::make_unexpected(std::move(error));
  }
  if (table.create == nullptr) return Instance(nullptr, nullptr, library);

  std::vector<koppel_value> lowered;
  lowered.reserve(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) lowered.push_back(lower(parameters[i], values[i]));
  const Host host(log, name);
  void* instance = nullptr;
  const auto status = guarded([&] { return table.create(host.table(), lowered.data(), &instance); });
  if (!status || *status < 0) return tl::make_unexpected(refusal(*this, status, host.rejection()));
  return Instance(instance, table.destroy, library);
}

std::size_t JointType::nq() const {
  std::size_t count = 0;
  for (const Block& block : blocks) count += coordinate_count(block.kind);
  return count;
}

std::size_t JointType::nv() const {
  std::size_t count = 0;
  for (const Block& block : blocks) count += rate_count(block.kind);
  return count;
}

}  // namespace koppel
