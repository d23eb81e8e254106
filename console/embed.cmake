# SPDX-License-Identifier: Apache-2.0
# cmake -DNAME=console -DOUT=FILE.cpp -DSTYLE=FILE -DBODY=FILE -DSCRIPTS=FILE,FILE,... -P embed.cmake: a page as
# C++ arrays. The scripts become one, in a function of their own.
string(REPLACE "," ";" SCRIPTS "${SCRIPTS}")
set(script "(() => {\n\"use strict\";\n")
foreach(file ${SCRIPTS})
  file(READ ${file} text)
  string(APPEND script "${text}")
endforeach()
string(APPEND script "})();\n")
set(joined ${OUT}.js)
file(WRITE ${joined} "${script}")

# "sha256-" and the digest in base64: three bytes of hex digits make four letters.
file(SHA256 ${joined} hex)
set(letters ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/)
set(hash "sha256-")
foreach(at RANGE 0 60 6)
  string(SUBSTRING ${hex}0000 ${at} 6 digits)
  math(EXPR word "0x${digits}")
  foreach(shift 18 12 6 0)
    math(EXPR letter "(${word} >> ${shift}) & 63")
    string(SUBSTRING ${letters} ${letter} 1 letter)
    string(APPEND hash ${letter})
  endforeach()
endforeach()
# 32 bytes: the last letter of 44 is padding.
string(SUBSTRING ${hash} 0 50 hash)
file(WRITE ${OUT}.hash "${hash}=")

include(${CMAKE_CURRENT_LIST_DIR}/../cmake/embed_files.cmake)
array_of(${NAME}_style "${STYLE}")
array_of(${NAME}_body "${BODY}")
array_of(${NAME}_script "${joined}")
array_of(${NAME}_script_hash "${OUT}.hash")
write_arrays(${OUT} app/console/assets.h)
