guen::mechanical_system! { pub system Chain10 {
            constants { m > 0, l > 0, g = 9.81 }
            coordinates { q1, q2, q3, q4, q5, q6, q7, q8, q9, q10 }
            let angle1 = q1; let p1 = vec(l*sin(angle1), -l*cos(angle1));
            let angle2 = q2; let p2 = p1 + vec(l*sin(angle2), -l*cos(angle2));
            let angle3 = q3; let p3 = p2 + vec(l*sin(angle3), -l*cos(angle3));
            let angle4 = q4; let p4 = p3 + vec(l*sin(angle4), -l*cos(angle4));
            let angle5 = q5; let p5 = p4 + vec(l*sin(angle5), -l*cos(angle5));
            let angle6 = q6; let p6 = p5 + vec(l*sin(angle6), -l*cos(angle6));
            let angle7 = q7; let p7 = p6 + vec(l*sin(angle7), -l*cos(angle7));
            let angle8 = q8; let p8 = p7 + vec(l*sin(angle8), -l*cos(angle8));
            let angle9 = q9; let p9 = p8 + vec(l*sin(angle9), -l*cos(angle9));
            let angle10 = q10; let p10 = p9 + vec(l*sin(angle10), -l*cos(angle10));
            parameters { w1 = dot(q1); w2 = dot(q2); w3 = dot(q3); w4 = dot(q4); w5 = dot(q5); w6 = dot(q6); w7 = dot(q7); w8 = dot(q8); w9 = dot(q9); w10 = dot(q10); }
            particles { m at p1; m at p2; m at p3; m at p4; m at p5; m at p6; m at p7; m at p8; m at p9; m at p10; }
            gravity = vec(0, -g);
        } }
