# The comments of the headers as doxygen reads them. The first one describes the file; those behind a member, a value
# or a parameter belong to it; headings and the names that the linker sees are left out. Lines keep their numbers.
1{N; s@^.*\n/\* @/** \\file\n * @; s@^.*\n// @/// \\file\n/// @}
/^ *\/\* ---/b
s@^#define microtin_.*@@
s@^( *)/\* @\1/** @
s@^( *)// @\1/// @
s@([;,)}] *)/\* @\1/**< @
s@([;,] +)// @\1///< @
s@ #if@ \\#if@
