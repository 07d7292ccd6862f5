//! Kernels on graphics processors through CUDA. Its libraries are looked for when a program asks for a device.
#![allow(unsafe_code, reason = "libraries are looked for, and kernels of our own are launched")]

use std::sync::{Arc, Mutex, PoisonError};

use cudarc::driver::{
    CudaContext, CudaFunction, CudaStream, DriverError, LaunchConfig, PushKernelArg, sys as driver,
};
use cudarc::nvrtc::{CompileError, CompileOptions, Ptx, compile_ptx_with_opts, sys as compiler};
use guen_runtime::{Kernel, KernelMethod};

use super::{Device, DeviceFault, KernelBatch, KernelEngine, KernelOutcome};

/// The threads of a block: a few warps, so that motions with large states find registers.
const BLOCK: usize = 128;

/// A graphics processor.
pub(super) struct Cuda {
    context: Arc<CudaContext>,
    stream: Arc<CudaStream>,
    /// The kernels that are compiled, by their methods; all are of one system.
    compiled: Mutex<Vec<(KernelMethod, CudaFunction)>>,
}

impl Cuda {
    /// Opens a device.
    pub(super) fn open(number: usize) -> Result<Self, DeviceFault> {
        // The bindings panic where a library is missing: so it is looked for first.
        // SAFETY: the libraries of the system are loaded, which run their own initialisers.
        let (has_driver, has_compiler) =
            unsafe { (driver::is_culib_present(), compiler::is_culib_present()) };
        if !has_driver {
            return Err(DeviceFault::NoDriver);
        }
        if !has_compiler {
            return Err(DeviceFault::NoCompiler);
        }
        let context = CudaContext::new(number)
            .map_err(|error| DeviceFault::NoDevice { device: Device::Cuda(number), reason: words(error) })?;
        let stream = context.default_stream();
        Ok(Self { context, stream, compiled: Mutex::default() })
    }

    /// The kernel, compiled.
    fn function(&self, kernel: &Kernel) -> Result<CudaFunction, DeviceFault> {
        let mut compiled = self.compiled.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, function)) = compiled.iter().find(|(method, _)| *method == kernel.method()) {
            return Ok(function.clone());
        }
        let program = compile(kernel)?;
        let module = self.context.load_module(program).map_err(stopped)?;
        let function = module.load_function(&kernel.entry().to_string()).map_err(stopped)?;
        compiled.push((kernel.method(), function.clone()));
        Ok(function)
    }
}

/// Compiles a kernel for devices of every kind.
fn compile(kernel: &Kernel) -> Result<Ptx, DeviceFault> {
    // Fused operations, and quotients and roots that are rounded otherwise, would have other bits.
    let options = CompileOptions {
        fmad: Some(false),
        ftz: Some(false),
        prec_div: Some(true),
        prec_sqrt: Some(true),
        ..CompileOptions::default()
    };
    compile_ptx_with_opts(kernel.to_string(), options).map_err(|error| {
        let log = match &error {
            CompileError::CompileError { log, .. } => log.to_string_lossy().into_owned(),
            other => other.to_string(),
        };
        DeviceFault::Compiler { log }
    })
}

/// The driver's words.
fn words(error: DriverError) -> String {
    error.error_string().map_or_else(|_| error.to_string(), |text| text.to_string_lossy().into_owned())
}

fn stopped(error: DriverError) -> DeviceFault {
    DeviceFault::Stopped { reason: words(error) }
}

impl KernelEngine for Cuda {
    fn run(&self, kernel: &Kernel, batch: &KernelBatch<'_>) -> Result<KernelOutcome, DeviceFault> {
        let function = self.function(kernel)?;
        let stream = &self.stream;
        // An array of a word where there would be none, which the driver does not have.
        let send = |numbers: &[f64]| {
            let sent = if numbers.is_empty() { &[0.0][..] } else { numbers };
            stream.clone_htod(sent).map_err(stopped)
        };
        let (numbers, starts) = (send(&batch.numbers)?, send(&batch.starts)?);
        let (settings, times) = (send(&batch.settings)?, send(batch.times)?);
        let [of_ends, of_samples, of_work] = batch.lengths();
        let mut ends = stream.alloc_zeros::<f64>(of_ends).map_err(stopped)?;
        let mut samples = stream.alloc_zeros::<f64>(of_samples.max(1)).map_err(stopped)?;
        let mut work = stream.alloc_zeros::<u64>(of_work).map_err(stopped)?;
        let (count, systems) = (batch.motions as u64, batch.systems as u64);
        let too_many = |_| DeviceFault::Stopped { reason: "too many motions or times at once".to_owned() };
        let stops = i32::try_from(batch.times.len()).map_err(too_many)?;
        let blocks = u32::try_from(batch.motions.div_ceil(BLOCK)).map_err(too_many)?;
        let keep = i32::from(batch.keep);
        let mut launch = stream.launch_builder(&function);
        launch.arg(&count).arg(&systems).arg(&numbers).arg(&starts).arg(&batch.t0);
        launch.arg(&settings).arg(&stops).arg(&times).arg(&keep);
        launch.arg(&mut ends).arg(&mut samples).arg(&mut work);
        let threads =
            LaunchConfig { grid_dim: (blocks, 1, 1), block_dim: (BLOCK as u32, 1, 1), shared_mem_bytes: 0 };
        // SAFETY: these are the parameters of the kernel in their order, and the lengths of the arrays are those that it reads and
        // writes for `count` motions; threads beyond return at once.
        unsafe { launch.launch(threads) }.map_err(stopped)?;
        let read = |array| stream.clone_dtoh(array).map_err(stopped);
        let (ends, mut samples) = (read(&ends)?, read(&samples)?);
        let work = stream.clone_dtoh(&work).map_err(stopped)?;
        stream.synchronize().map_err(stopped)?;
        samples.truncate(of_samples);
        Ok(KernelOutcome { ends, samples, work })
    }
}

#[cfg(test)]
mod tests {
    use guen_runtime::lanes::Lanes;
    use guen_runtime::steppers::{Dop853, Rk4, Rk8};
    use guen_runtime::{Laned, Real, Source, Sourced, System};

    use super::*;
    use crate::ensemble::{DeviceMethod, Ensemble};

    /// A pendulum that is pushed, by hand: `q'' = c sqrt(1 + w^2) sin(t) - k sin(q)/c`.
    #[derive(Clone, Copy, Debug)]
    struct Pendulum<R>([R; 2]);

    impl<R: Real> System<R, 2> for Pendulum<R> {
        #[inline]
        fn rhs(&self, t: R, &[q, w]: &[R; 2]) -> [R; 2] {
            let [c, k] = self.0;
            R::vectorize(
                #[inline(always)]
                || [w, c * (R::one() + w * w).sqrt() * t.sin() - k * q.sin() / c],
            )
        }
    }

    impl Laned<2> for Pendulum<f64> {
        type Over<L: Lanes> = Pendulum<L>;

        fn gather<'a, L: Lanes>(member: impl Fn(usize) -> &'a Self) -> Pendulum<L> {
            Pendulum([0, 1].map(|i| L::from_fn(|lane| member(lane).0[i])))
        }
    }

    impl Sourced<2> for Pendulum<f64> {
        const SOURCE: Source = Source {
            name: "pendulum",
            program: "#define pendulum_CONSTANTS 1\n#define pendulum_PREPARED 0\n#define pendulum_STATES 2\n#define pendulum_INPUTS 1\n\
                #define pendulum_DOMAIN 0\n\
                GUEN_FUNCTION void pendulum_rhs(const double *c, const double *k, double t, const double *s, const double *u, double *r)\n\
                {\n    (void)k;\n    r[0] = s[1];\n    r[1] = c[0] * sqrt(1.0 + s[1] * s[1]) * guen_sin(t) - u[0] * guen_sin(s[0]) / c[0];\n}\n\
                GUEN_FUNCTION void pendulum_domain(const double *c, const double *k, double t, const double *s, double *d)\n\
                {\n    (void)c;\n    (void)k;\n    (void)t;\n    (void)s;\n    (void)d;\n}\n",
            steps: true,
            adaptive: true,
            series: false,
        };
        const NUMBERS: usize = 2;

        fn numbers(&self) -> impl Iterator<Item = f64> {
            self.0.into_iter()
        }
    }

    fn pendulums() -> Ensemble<Pendulum<f64>, 2> {
        Ensemble::of_systems((0..301).map(|i| {
            let x = f64::from(i) / 301.0;
            // A start that is no number fails alone.
            let start = [if i == 150 { f64::NAN } else { 2.0 * x }, 1.0 - x];
            (Pendulum([0.5 + x, 9.81 * x]), start)
        }))
    }

    /// Compares bits with the CPU on the first device, if there is one.
    fn compare(method: &impl DeviceMethod) {
        let times = [0.5, 1.25, 3.0];
        let expected = pendulums().on(Device::Cpu).sample(method, 0.0, &times);
        let on_device = pendulums().on(Device::Cuda(0)).with_batch(100);
        let found = on_device.sample(method, 0.0, &times);
        match on_device.fault() {
            Some(fault) => {
                println!("no device to compare with: {fault}");
                let is_absent = matches!(
                    fault,
                    DeviceFault::NoDriver | DeviceFault::NoCompiler | DeviceFault::NoDevice { .. }
                );
                assert!(is_absent && found.fault.as_ref() == Some(fault) && found.device == Device::Cpu);
            }
            None => assert_eq!((&found.fault, found.device, found.again), (&None, Device::Cuda(0), 1)),
        }
        let bits =
            |states: &[[f64; 2]]| states.as_flattened().iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        for (index, (found, expected)) in found.motions.iter().zip(&expected.motions).enumerate() {
            assert_eq!(bits(&found.states), bits(&expected.states), "{index}");
            assert_eq!(found.end.is_ok(), expected.end.is_ok(), "{index}");
            if let (Ok(found), Ok(expected)) = (&found.end, &expected.end) {
                assert_eq!(found, expected, "{index}");
            }
        }
        assert_eq!(expected.motions.iter().filter(|motion| motion.end.is_err()).count(), 1);
    }

    #[test]
    fn motions_on_a_device_have_the_bits_of_the_cpu() {
        compare(&Rk4::new(0.01));
        compare(&Rk8::new(0.05));
        compare(&Dop853::new(1e-9, 1e-9));
    }

    #[test]
    fn kernels_are_compiled_without_fused_operations() {
        // SAFETY: as above.
        if !unsafe { compiler::is_culib_present() } {
            println!("no compiler of kernels: {}", DeviceFault::NoCompiler);
            return;
        }
        for method in [KernelMethod::Rk4, KernelMethod::Rk8, KernelMethod::Dop853] {
            let text = compile(&Pendulum::SOURCE.kernel(method).unwrap()).unwrap().to_src();
            // Products that say how they round are not contracted later on either.
            let has = |word: &str| text.contains(word);
            assert!(has("mul.rn.f64") && has("add.rn.f64") && has("div.rn.f64") && has("sqrt.rn.f64"));
            assert!(!has("fma.") && !has("mul.f64") && !has("add.f64") && !has("approx"), "{text}");
        }
        let source = Source { program: "no C", ..Pendulum::SOURCE };
        let refused = compile(&source.kernel(KernelMethod::Rk4).unwrap());
        assert!(matches!(refused, Err(DeviceFault::Compiler { log }) if log.contains("error")));
    }

    #[test]
    fn a_device_that_is_not_there_is_an_error() {
        let fault = Cuda::open(1000).err().expect("no machine has so many");
        println!("{fault}");
        assert!(matches!(
            fault,
            DeviceFault::NoDriver
                | DeviceFault::NoCompiler
                | DeviceFault::NoDevice { device: Device::Cuda(1000), .. }
        ));
    }
}
