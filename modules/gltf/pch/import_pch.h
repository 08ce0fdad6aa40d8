// SPDX-License-Identifier: MIT
//
// What most files of the importer include, compiled once: tinygltf's header takes most of a file's time.
#include "../import.h"

#include <algorithm>
#include <cmath>
#include <cstring>
