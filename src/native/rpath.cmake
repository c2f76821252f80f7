# Where an installed module finds Pinocchio's libraries, relative to the module itself.
if(APPLE)
  set(PINIK_RPATH "@loader_path/../cmeel.prefix/lib")
else()
  set(PINIK_RPATH "$ORIGIN/../cmeel.prefix/lib")
endif()
