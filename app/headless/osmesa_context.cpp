#include "app/headless/offscreen_context.h"

#if __has_include(<GL/osmesa.h>)

#include <GL/osmesa.h>
#include <dlfcn.h>

#include <array>
#include <cstdint>

namespace brume {

namespace {

// Opened at run time instead of linked: Mesa 25.1 has no OSMesa any more, and a program that links it would not even
// start there. RTLD_LOCAL also keeps its gl* symbols away from everybody else's.
struct OsmesaLibrary {
  decltype(&OSMesaCreateContextAttribs) create = nullptr;
  decltype(&OSMesaDestroyContext) destroy = nullptr;
  decltype(&OSMesaMakeCurrent) make_current = nullptr;
  decltype(&OSMesaGetCurrentContext) current = nullptr;
  decltype(&OSMesaGetProcAddress) proc_address = nullptr;
};

template <class Function> bool find(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  return function != nullptr;
}

Result<OsmesaLibrary> open_osmesa() {
  void* library = nullptr;
  // Never closed: its LLVM keeps thread and exit handlers that must not lose their code.
  for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"})
    if (!library) library = dlopen(name, RTLD_NOW | RTLD_LOCAL);
  if (!library)
    return Error{ErrorCode::Internal, "libOSMesa.so.8 was not found; install the package libosmesa6 (or use EGL)."};
  OsmesaLibrary osmesa;
  if (!find(library, "OSMesaCreateContextAttribs", osmesa.create) ||
      !find(library, "OSMesaDestroyContext", osmesa.destroy) ||
      !find(library, "OSMesaMakeCurrent", osmesa.make_current) ||
      !find(library, "OSMesaGetCurrentContext", osmesa.current) ||
      !find(library, "OSMesaGetProcAddress", osmesa.proc_address))
    return Error{ErrorCode::Internal,
                 "libOSMesa is too old (no OSMesaCreateContextAttribs); install libosmesa6 of Mesa 12 or newer."};
  return osmesa;
}

// A GlLoader has no state, so the address of this function is looked up among what is already open.
void* osmesa_address(const char* name) {
  const Result<OsmesaLibrary> osmesa = open_osmesa();
  return osmesa ? reinterpret_cast<void*>(osmesa->proc_address(name)) : nullptr;
}

class OsmesaContext final : public OffscreenContext {
 public:
  explicit OsmesaContext(const OsmesaLibrary& library) : library_(library) {}
  ~OsmesaContext() override {
    if (!context_) return;
    if (library_.current() == context_) library_.make_current(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0);
    library_.destroy(context_);
  }

  Result<void> create() {
    const std::array<int, 13> attributes = {OSMESA_FORMAT,
                                            OSMESA_RGBA,
                                            OSMESA_DEPTH_BITS,
                                            0,
                                            OSMESA_STENCIL_BITS,
                                            0,
                                            OSMESA_PROFILE,
                                            OSMESA_CORE_PROFILE,
                                            OSMESA_CONTEXT_MAJOR_VERSION,
                                            3,
                                            OSMESA_CONTEXT_MINOR_VERSION,
                                            3,
                                            0};
    context_ = library_.create(attributes.data(), nullptr);
    if (!context_)
      return Error{ErrorCode::Internal,
                   "OSMesa could not make an OpenGL 3.3 core context; update the package libosmesa6."};
    return make_current();
  }

  Result<void> make_current() override {
    if (!library_.make_current(context_, buffer_.data(), GL_UNSIGNED_BYTE, kSide, kSide))
      return Error{ErrorCode::Internal, "OSMesaMakeCurrent failed."};
    return {};
  }
  GlLoader loader() const override { return osmesa_address; }
  const char* name() const override { return "OSMesa"; }

 private:
  // OSMesa insists on a default framebuffer; nothing is ever drawn into it.
  static constexpr int kSide = 4;

  OsmesaLibrary library_;
  OSMesaContext context_ = nullptr;
  std::array<std::uint8_t, kSide * kSide * 4> buffer_{};
};

}  // namespace

Result<std::unique_ptr<OffscreenContext>> create_osmesa_context() {
  const Result<OsmesaLibrary> library = open_osmesa();
  if (!library) return library.error();
  auto context = std::make_unique<OsmesaContext>(*library);
  if (const Result<void> made = context->create(); !made) return made.error();
  return std::unique_ptr<OffscreenContext>(std::move(context));
}

}  // namespace brume

#else

namespace brume {

Result<std::unique_ptr<OffscreenContext>> create_osmesa_context() {
  return Error{ErrorCode::Internal, "this Brume was built without OSMesa (package libosmesa6-dev); use EGL."};
}

}  // namespace brume

#endif
