# cmake -DFROM=HEADER -DTO=FILE -P AsGlsl.cmake: a header of src/kernels, which is C++, as GLSL.
#
# What is C++ alone goes: preprocessor, namespaces, using, static_assert, templates (`Real` is what the shader defines it as).
# A reference becomes `inout`, and literals of double precision get their suffix. Each function becomes `precise`: none of
# its arithmetic is fused or put into another order, as in C++ (-ffp-contract=off).
file(READ ${FROM} text)
string(REGEX REPLACE "namespace [^\n]*{\n|} // namespace[^\n]*|//[^\n]*" "" text "${text}")
string(REGEX REPLACE "\n(#|using )[^\n]*" "\n" text "${text}")
string(REGEX REPLACE "static_assert\\([^;]*;" "" text "${text}")
string(REGEX REPLACE "template <typename Real>|std::" "" text "${text}")
string(REGEX REPLACE "(inline )?constexpr" "const" text "${text}")
string(REGEX REPLACE "inline " "precise " text "${text}")
string(REGEX REPLACE "([A-Za-z]+) &([a-z])" "inout precise \\1 \\2" text "${text}")
set(before "([^A-Za-z0-9_.])")
string(REGEX REPLACE "${before}([0-9]+\\.[0-9]*(e-?[0-9]+)?|[0-9]+e-?[0-9]+)([^0-9a-z.])" "\\1\\2lf\\4" text "${text}")
file(WRITE ${TO} "${text}")
