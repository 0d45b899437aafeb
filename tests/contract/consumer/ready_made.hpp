#pragma once
#include <crankloop/scenes.hpp>
