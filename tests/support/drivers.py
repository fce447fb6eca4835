"""Where tests of one driver find it: OCL_ICD_VENDORS=icd("pocl.icd").

In:    OCL_ICD_VENDORS, as share_kernels sets it.
Out:   the file of that name in there, or the name alone, which the OpenCL loader looks for in /etc/OpenCL/vendors.
"""

import os


def icd(name):
    path = os.path.join(os.environ.get("OCL_ICD_VENDORS", ""), name)
    return path if os.path.isabs(path) and os.path.exists(path) else name
