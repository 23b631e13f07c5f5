/* Read before the C that mypyc makes: what is only called where something has gone wrong (hatch_build.py).

   mypyc says at each call what to do if it fails; half of the code is that.  Told that these functions are hardly ever
   called, the compiler puts all that leads to them apart, and makes it small: it stays on the disk, and what runs
   stands closer together.  They are declared as in CPy.h and pyerrors.h of mypyc and Python, whatever comes later. */

struct _object;

#define COLD __attribute__((cold))
COLD void CPy_AddTraceback(const char *, const char *, int, struct _object *);
COLD void CPy_TypeErrorTraceback(const char *, const char *, int, struct _object *, const char *, struct _object *);
COLD void CPy_TypeError(const char *, struct _object *);
COLD void CPy_AttributeError(const char *, const char *, const char *, const char *, int, struct _object *);
COLD void CPyError_OutOfMemory(void);
COLD static void CPy_DecRef(struct _object *);
COLD static void CPy_XDecRef(void *);
COLD void PyErr_SetString(struct _object *, const char *);
#undef COLD
