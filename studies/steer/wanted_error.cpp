// SPDX-License-Identifier: Apache-2.0
#include "studies/steer/wanted_error.h"

namespace earthshine::studies {

std::string limit_name(Limit limit) {
  switch (limit) {
    case Limit::None:
      return "none";
    case Limit::Time:
      return "time";
    case Limit::Memory:
      return "memory";
    case Limit::Settings:
      return "settings";
    case Limit::Steps:
      return "steps";
    case Limit::Stopped:
      return "stopped";
  }
  return "";
}

}  // namespace earthshine::studies
