#include "zoneplate/base/file.h"
namespace zoneplate {}
