// SPDX-License-Identifier: Apache-2.0
// `console --serve`: the live preview on 127.0.0.1, until the program is interrupted.
//
// Only requests with the call's random token are answered, and only those that name this host
// (a page of another site whose name was bound to 127.0.0.1 sends its own name) and come from this
// page, if they say from where. Bodies have at most 64 KiB.
#pragma once

#include "app/command.h"

namespace earthshine::app {

// False: built without cpp-httplib.
[[nodiscard]] bool can_serve();
// port: 0 for a free one. Prints the address once.
void serve(const SceneInput& scene, int port, const Common& common);

}  // namespace earthshine::app
