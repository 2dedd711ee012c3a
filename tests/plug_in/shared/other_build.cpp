// SPDX-License-Identifier: Apache-2.0
// A plug-in that was built for another program. It includes no header of Waymark, which would state this
// build.
extern "C" [[gnu::visibility("default")]] const char* waymark_plug_in_build();
extern "C" [[gnu::visibility("default")]] const char* waymark_plug_in_build() {
  return "waymark 0.0.1";
}
